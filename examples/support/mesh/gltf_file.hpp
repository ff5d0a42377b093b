// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "gltf_value.hpp"

namespace support {

/// The JSON and the buffers of a glTF 2 file, as text or GLB.
class GltfFile {
public:
    /// Throws InputError where the file is damaged or not version 2, or its JSON is nested too
    /// deeply. `path` and `text` must outlive the object.
    GltfFile(const std::filesystem::path& path, std::string_view text);

    [[nodiscard]] GltfValue root() const { return {path_, json_, ""}; }

    /// The number of elements of an array of the root; 0 where it is missing.
    [[nodiscard]] std::size_t count(const std::string& array) const;
    /// The element of an array of the root, at an index that is a value in the file.
    [[nodiscard]] GltfValue element(const std::string& array, const GltfValue& index) const;
    [[nodiscard]] std::size_t element_index(const std::string& array, const GltfValue& index) const;

    /// The bytes of a buffer, at least as many as its `byteLength`. Reads files in the mesh's
    /// folder only.
    [[nodiscard]] std::string_view buffer(const GltfValue& index);

    /// The size of all bytes that were read.
    [[nodiscard]] std::uint64_t size_bytes() const { return size_bytes_; }
    [[nodiscard]] std::uint64_t bytes_after_end() const { return bytes_after_end_; }
    /// Whether the file says that it uses an extension.
    [[nodiscard]] bool uses_extension(std::string_view name) const;

private:
    [[noreturn]] void fail(const std::string& what) const;
    void split_glb(std::string_view text, std::string_view& json_text);
    void parse(std::string_view json_text, std::size_t offset);
    [[nodiscard]] std::string_view load_buffer(const GltfValue& buffer, std::size_t number);

    const std::filesystem::path& path_;
    nlohmann::json json_;
    std::string_view binary_chunk_;
    bool has_binary_chunk_ = false;
    std::map<std::size_t, std::string> loaded_;  // of data URIs and files
    std::map<std::size_t, std::string_view> buffers_;
    std::uint64_t size_bytes_ = 0;
    std::uint64_t bytes_after_end_ = 0;
};

}  // namespace support
