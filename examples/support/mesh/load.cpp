// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cctype>
#include <new>
#include <stdexcept>
#include <string>
#include <string_view>

#include "input_error.hpp"
#include "mesh.hpp"
#include "raw_mesh.hpp"
#include "read_file.hpp"
#include "stl.hpp"
#include "triangulate.hpp"

namespace support {
namespace {

constexpr std::uint64_t most_bytes_of_mesh = std::uint64_t{1} << 30;

std::string lower_extension(const std::filesystem::path& path) {
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return extension;
}

// The contents decide for formats that start with a known mark; the extension decides for the
// others.
MeshReader reader_of(const std::filesystem::path& path, std::string_view text) {
    const std::string extension = lower_extension(path);
    if (text.starts_with("ply\n") || text.starts_with("ply\r") || extension == ".ply")
        return read_ply;
    if (text.starts_with("glTF") || extension == ".gltf" || extension == ".glb") return read_gltf;
    if (extension == ".obj") return read_obj;
    if (extension == ".off") return read_off;
    if (extension == ".stl" || is_binary_stl(text)) return read_stl;
    return read_with_assimp;
}

}  // namespace

Mesh load_mesh(const std::filesystem::path& path) {
    const std::string name = quoted("mesh", path);
    try {
        std::string text = read_file("mesh", path, most_bytes_of_mesh);
        // Skips the byte order mark that some editors put before UTF-8 text.
        if (text.starts_with("\xEF\xBB\xBF") && !is_binary_stl(text)) text.erase(0, 3);
        RawMesh raw = reader_of(path, text)(path, text);
        std::string().swap(text);
        if (raw.is_too_large())
            throw InputError(name + " has " + std::to_string(raw.positions.size()) +
                             " vertices and " + std::to_string(raw.corners.size()) +
                             " corners of faces, the limit is 4294967294 each");
        const std::size_t vertices = raw.positions.size();
        Mesh mesh = clean_mesh(triangulate(std::move(raw)));
        if (mesh.triangles.empty())
            throw InputError(name + " has no triangle that can be drawn (" +
                             std::to_string(vertices) + " vertices, " +
                             std::to_string(mesh.drops.triangles()) + " faces dropped, " +
                             std::to_string(mesh.drops.points_and_lines) + " points and lines)");
        return mesh;
    } catch (const std::bad_alloc&) {
        throw InputError(name + " does not fit into memory");
    } catch (const std::length_error&) {
        throw InputError(name + " does not fit into memory");
    }
}

}  // namespace support
