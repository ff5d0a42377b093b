// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace support {

/// A value in the JSON of a glTF file. It knows its place, which messages give as a JSON pointer:
/// "/meshes/0/primitives". Functions throw InputError where the value is of another kind.
class GltfValue {
public:
    GltfValue(const std::filesystem::path& path, const nlohmann::json& json, std::string place)
        : path_(&path), json_(&json), place_(std::move(place)) {}

    [[noreturn]] void fail(const std::string& what) const;

    /// The member of an object; nothing if it is missing.
    [[nodiscard]] std::optional<GltfValue> find(const std::string& key) const;
    /// The member of an object; throws InputError if it is missing.
    [[nodiscard]] GltfValue at(const std::string& key) const;
    /// Elements of an array.
    [[nodiscard]] std::size_t size() const;
    [[nodiscard]] GltfValue operator[](std::size_t index) const;

    /// An integer from 0 to `greatest`.
    [[nodiscard]] std::uint64_t integer(std::uint64_t greatest = 0xFFFFFFFF) const;
    [[nodiscard]] double number() const;
    /// An array of this many numbers.
    [[nodiscard]] std::vector<double> numbers(std::size_t count) const;
    [[nodiscard]] const std::string& text() const;
    [[nodiscard]] bool boolean() const;

    [[nodiscard]] std::uint64_t integer_or(const std::string& key, std::uint64_t fallback) const;

private:
    const std::filesystem::path* path_;
    const nlohmann::json* json_;
    std::string place_;
};

}  // namespace support
