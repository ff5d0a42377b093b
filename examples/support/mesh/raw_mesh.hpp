// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "mesh.hpp"

namespace support {

[[nodiscard]] inline bool is_finite(const glm::vec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// The polygons of a file, as a reader found them. clean_mesh() checks indices and coordinates, so
/// a reader passes on what the file says: an index that does not exist becomes `no_vertex`, and a
/// coordinate may be NaN.
struct RawMesh {
    static constexpr std::uint32_t no_vertex = 0xFFFFFFFF;
    /// The limit of vertices, and that of corners.
    static constexpr std::uint32_t most = no_vertex - 1;

    std::vector<glm::vec3> positions;
    /// One for each position, of any length, 0 where the file has none; or empty.
    std::vector<glm::vec3> normals;
    std::vector<glm::vec4> colours;  ///< linear RGB and opacity of each position; or empty

    std::vector<std::uint32_t> corners;    ///< vertices of all polygons, one polygon after another
    std::vector<std::uint32_t> face_ends;  ///< for each polygon: the end of its corners
    std::vector<std::uint32_t>
        face_materials;  ///< index into `materials` for each polygon; or empty
    std::vector<MeshMaterial> materials;

    MeshDrops drops;                     ///< what the reader itself left out
    bool ends_within_line = false;       ///< as Mesh::ends_within_line
    std::uint64_t ignored_textures = 0;  ///< textures that the file names for what is drawn
    UpAxis up = UpAxis::unknown;         ///< of the format or the file, where it has one
    std::vector<std::string> notes;      ///< what else was left out, one line each, with its place

    [[nodiscard]] bool is_too_large() const {
        return positions.size() > most || corners.size() > most;
    }
};

/// A reader of one format. `text` is the whole file; `path` is for messages and for files beside
/// it. Throws InputError, in one line that names the file and the place, where the file is damaged
/// or has something that the reader does not support. Never trusts a count before it has seen the
/// data.
using MeshReader = RawMesh (*)(const std::filesystem::path& path, const std::string& text);

RawMesh read_ply(const std::filesystem::path& path, const std::string& text);
RawMesh read_off(const std::filesystem::path& path, const std::string& text);
RawMesh read_stl(const std::filesystem::path& path, const std::string& text);
RawMesh read_obj(const std::filesystem::path& path, const std::string& text);
RawMesh read_gltf(const std::filesystem::path& path, const std::string& text);
/// All other formats: Assimp, in a process of its own, so that an abort inside it is an error.
RawMesh read_with_assimp(const std::filesystem::path& path, const std::string& text);

}  // namespace support
