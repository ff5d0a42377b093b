// SPDX-License-Identifier: MIT
#include "gltf_value.hpp"

#include <cmath>

#include "input_error.hpp"
#include "read_file.hpp"

namespace support {

void GltfValue::fail(const std::string& what) const {
    throw InputError(quoted("mesh", *path_) + ", " + (place_.empty() ? "/" : place_) + ": " + what);
}

std::optional<GltfValue> GltfValue::find(const std::string& key) const {
    if (!json_->is_object()) fail("is not an object");
    const auto member = json_->find(key);
    if (member == json_->end()) return std::nullopt;
    return GltfValue(*path_, *member, place_ + "/" + key);
}

GltfValue GltfValue::at(const std::string& key) const {
    std::optional<GltfValue> member = find(key);
    if (!member) fail("'" + key + "' is missing");
    return *std::move(member);
}

std::size_t GltfValue::size() const {
    if (!json_->is_array()) fail("is not an array");
    return json_->size();
}

GltfValue GltfValue::operator[](std::size_t index) const {
    return {*path_, json_->at(index), place_ + "/" + std::to_string(index)};
}

std::uint64_t GltfValue::integer(std::uint64_t greatest) const {
    // Some exporters write integers as "3.0".
    if (json_->is_number()) {
        const auto value = json_->get<double>();
        if (value >= 0 && value <= static_cast<double>(greatest) && value == std::floor(value))
            return json_->get<std::uint64_t>();
    }
    fail("is not an integer from 0 to " + std::to_string(greatest));
}

double GltfValue::number() const {
    if (!json_->is_number()) fail("is not a number");
    return json_->get<double>();
}

std::vector<double> GltfValue::numbers(std::size_t count) const {
    if (size() != count)
        fail("has " + std::to_string(size()) + " values, it needs " + std::to_string(count));
    std::vector<double> values;
    for (std::size_t i = 0; i < count; ++i) values.push_back((*this)[i].number());
    return values;
}

const std::string& GltfValue::text() const {
    if (!json_->is_string()) fail("is not a string");
    return json_->get_ref<const std::string&>();
}

bool GltfValue::boolean() const {
    if (!json_->is_boolean()) fail("is not a boolean");
    return json_->get<bool>();
}

std::uint64_t GltfValue::integer_or(const std::string& key, std::uint64_t fallback) const {
    const std::optional<GltfValue> member = find(key);
    return member ? member->integer() : fallback;
}

}  // namespace support
