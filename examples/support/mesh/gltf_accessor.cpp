// SPDX-License-Identifier: MIT
#include "gltf_accessor.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <optional>
#include <utility>

namespace support {
namespace {

// Zeros that an accessor may have without a byte in the file. Bounds the memory for a small file.
constexpr std::size_t limit_zeros_bytes = std::size_t{1} << 28;

constexpr std::array<std::pair<std::string_view, std::size_t>, 7> shape_components = {
    {{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT2", 4}, {"MAT3", 9}, {"MAT4", 16}}};

std::size_t bytes_of(GltfType type) {
    switch (type) {
        case GltfType::int8:
        case GltfType::uint8:
            return 1;
        case GltfType::int16:
        case GltfType::uint16:
            return 2;
        case GltfType::uint32:
        case GltfType::float32:
            return 4;
    }
    return 0;
}

// Files are little-endian, and so is every machine that the examples run on.
template <typename T>
T load(const char* at) {
    T value;
    std::memcpy(&value, at, sizeof(T));
    return value;
}

double load_number(const char* at, GltfFormat format) {
    const auto scaled = [&](double value, double greatest) {
        return format.is_normalized ? std::max(value / greatest, -1.0) : value;
    };
    switch (format.type) {
        case GltfType::int8:
            return scaled(load<std::int8_t>(at), 127);
        case GltfType::uint8:
            return scaled(load<std::uint8_t>(at), 255);
        case GltfType::int16:
            return scaled(load<std::int16_t>(at), 32767);
        case GltfType::uint16:
            return scaled(load<std::uint16_t>(at), 65535);
        case GltfType::uint32:
            return load<std::uint32_t>(at);
        case GltfType::float32:
            return static_cast<double>(load<float>(at));
    }
    return 0;
}

std::string component_name(GltfFormat format) {
    return std::to_string(static_cast<int>(format.type)) +
           (format.is_normalized ? " (normalized)" : "");
}

// The bytes of `count` elements, `stride` apart, from `offset` on. Throws if the view is too short.
std::string_view view_bytes(GltfFile& file, const GltfValue& place, std::size_t element_bytes,
                            std::size_t count, std::size_t& stride) {
    const GltfValue view = file.element("bufferViews", place.at("bufferView"));
    const std::string_view buffer = file.buffer(view.at("buffer"));
    const std::uint64_t begin = view.integer_or("byteOffset", 0);
    const std::uint64_t length = view.at("byteLength").integer();
    if (begin > buffer.size() || length > buffer.size() - begin)
        view.fail("has " + std::to_string(length) + " bytes from byte " + std::to_string(begin) +
                  " on, the buffer has " + std::to_string(buffer.size()));
    const std::uint64_t offset = place.integer_or("byteOffset", 0);
    stride = view.integer_or("byteStride", element_bytes);
    if (stride < element_bytes)
        view.fail("has a 'byteStride' of " + std::to_string(stride) + ", an element has " +
                  std::to_string(element_bytes) + " bytes");
    if (count == 0) return {};
    // No product overflows: all factors have 32 bits.
    const std::uint64_t end = offset + stride * (count - 1) + element_bytes;
    if (end > length)
        place.fail("its " + std::to_string(count) + " elements need " + std::to_string(end) +
                   " bytes, the buffer view has " + std::to_string(length));
    return buffer.substr(begin + offset, end - offset);
}

}  // namespace

GltfAccessor::GltfAccessor(GltfFile& file, const GltfValue& index,
                           std::initializer_list<std::string_view> shapes,
                           std::initializer_list<GltfFormat> formats) {
    const GltfValue accessor = file.element("accessors", index);
    const std::string& shape = accessor.at("type").text();
    if (std::find(shapes.begin(), shapes.end(), shape) == shapes.end())
        accessor.at("type").fail("is not '" + std::string(*shapes.begin()) + "'");
    for (const auto& [name, components] : shape_components)
        if (name == shape) components_ = components;

    const std::optional<GltfValue> normalized = accessor.find("normalized");
    const auto type = static_cast<GltfType>(accessor.at("componentType").integer());
    format_ = {type, normalized && normalized->boolean()};
    if (std::find(formats.begin(), formats.end(), format_) == formats.end()) {
        std::string allowed;
        for (const GltfFormat format : formats)
            allowed += (allowed.empty() ? "" : ", ") + component_name(format);
        accessor.at("componentType")
            .fail("is " + component_name(format_) + ", it may be " + allowed);
    }
    element_bytes_ = bytes_of(format_.type) * components_;
    size_ = accessor.at("count").integer();
    read_view(file, accessor);
    if (const std::optional<GltfValue> sparse = accessor.find("sparse"))
        replace_sparse(file, *sparse);
}

void GltfAccessor::read_view(GltfFile& file, const GltfValue& accessor) {
    if (accessor.find("bufferView")) {
        bytes_ = view_bytes(file, accessor, element_bytes_, size_, stride_);
        return;
    }
    if (size_ > limit_zeros_bytes / element_bytes_)
        accessor.fail("has " + std::to_string(size_) + " elements without a buffer, the limit is " +
                      std::to_string(limit_zeros_bytes / element_bytes_));
    stride_ = element_bytes_;
    owned_.resize(size_ * element_bytes_);
}

void GltfAccessor::replace_sparse(GltfFile& file, const GltfValue& sparse) {
    if (owned_.empty()) {
        owned_.resize(size_ * element_bytes_);
        for (std::size_t i = 0; i < size_; ++i)
            std::memcpy(owned_.data() + i * element_bytes_, bytes_.data() + i * stride_,
                        element_bytes_);
        stride_ = element_bytes_;
    }
    const std::size_t replaced = sparse.at("count").integer();
    const GltfValue indices = sparse.at("indices");
    const GltfFormat index_format{static_cast<GltfType>(indices.at("componentType").integer()),
                                  false};
    if (index_format.type != GltfType::uint8 && index_format.type != GltfType::uint16 &&
        index_format.type != GltfType::uint32)
        indices.at("componentType").fail("is not an index type");
    std::size_t index_stride = 0, value_stride = 0;
    const std::string_view index_bytes =
        view_bytes(file, indices, bytes_of(index_format.type), replaced, index_stride);
    const std::string_view value_bytes =
        view_bytes(file, sparse.at("values"), element_bytes_, replaced, value_stride);
    for (std::size_t i = 0; i < replaced; ++i) {
        const auto index = static_cast<std::size_t>(
            load_number(index_bytes.data() + i * index_stride, index_format));
        if (index >= size_)
            indices.fail("names element " + std::to_string(index) + ", the accessor has " +
                         std::to_string(size_));
        std::memcpy(owned_.data() + index * element_bytes_, value_bytes.data() + i * value_stride,
                    element_bytes_);
    }
}

double GltfAccessor::number(std::size_t element, std::size_t component) const {
    const char* begin = owned_.empty() ? bytes_.data() : owned_.data();
    return load_number(begin + element * stride_ + component * bytes_of(format_.type), format_);
}

std::size_t gltf_accessor_size(const GltfFile& file, const GltfValue& index) {
    return file.element("accessors", index).at("count").integer();
}

}  // namespace support
