// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

#include <nlohmann/json.hpp>

#include "oit/support/files.hpp"

namespace cellist::test {

using nlohmann::json;

inline std::string base64(const std::string& bytes) {
    constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t word = 0;
        for (std::size_t k = 0; k < 3; ++k)
            word =
                word << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
        for (std::size_t k = 0; k < 4; ++k)
            out += i + k > bytes.size() ? '=' : digits[word >> (18 - 6 * k) & 63];
    }
    return out;
}

inline void append_chunk(std::string& glb, std::string bytes, std::uint32_t type, char padding) {
    bytes.resize((bytes.size() + 3) / 4 * 4, padding);
    append_bytes(glb, static_cast<std::uint32_t>(bytes.size()));
    append_bytes(glb, type);
    glb += bytes;
}

/// A GLB file of this JSON and its first buffer.
inline std::string glb_text(const std::string& json_text, const std::string& buffer) {
    std::string chunks, glb = "glTF";
    append_chunk(chunks, json_text, 0x4E4F534A, ' ');
    append_chunk(chunks, buffer, 0x004E4942, '\0');
    append_bytes(glb, std::uint32_t{2});
    append_bytes(glb, static_cast<std::uint32_t>(12 + chunks.size()));
    return glb + chunks;
}

/// A scene whose buffers, views and accessors grow as values are added.
struct GltfScene {
    json root = {{"asset", {{"version", "2.0"}}},
                 {"scene", 0},
                 {"scenes", {{{"nodes", json::array()}}}},
                 {"nodes", json::array()},
                 {"meshes", json::array()},
                 {"accessors", json::array()},
                 {"bufferViews", json::array()}};
    std::string buffer;

    std::size_t add_view(const std::string& bytes, std::size_t stride = 0) {
        buffer.resize((buffer.size() + 3) / 4 * 4, '\x7F');
        json view = {{"buffer", 0}, {"byteOffset", buffer.size()}, {"byteLength", bytes.size()}};
        if (stride > 0) view["byteStride"] = stride;
        root["bufferViews"].push_back(view);
        buffer += bytes;
        return root["bufferViews"].size() - 1;
    }

    std::size_t add_accessor(std::size_t view, int component_type, const char* type,
                             std::size_t count) {
        root["accessors"].push_back({{"bufferView", view},
                                     {"componentType", component_type},
                                     {"type", type},
                                     {"count", count}});
        return root["accessors"].size() - 1;
    }

    template <class T>
    std::size_t add_values(const std::vector<T>& values, int component_type, const char* type,
                           std::size_t components) {
        std::string bytes;
        for (const T& value : values) append_bytes(bytes, value);
        return add_accessor(add_view(bytes), component_type, type, values.size() / components);
    }

    /// A node at the root of the scene that draws one primitive.
    void add_primitive(const json& primitive, json node = json::object()) {
        root["meshes"].push_back({{"primitives", {primitive}}});
        node["mesh"] = root["meshes"].size() - 1;
        root["scenes"][0]["nodes"].push_back(root["nodes"].size());
        root["nodes"].push_back(node);
    }

    [[nodiscard]] std::string glb() const {
        json whole = root;
        whole["buffers"] = {{{"byteLength", buffer.size()}}};
        return glb_text(whole.dump(), buffer);
    }
    [[nodiscard]] std::string gltf(const std::string& uri = "") const {
        json whole = root;
        whole["buffers"] = {
            {{"byteLength", buffer.size()},
             {"uri",
              uri.empty() ? "data:application/octet-stream;base64," + base64(buffer) : uri}}};
        return whole.dump(2);
    }
};

}  // namespace cellist::test
