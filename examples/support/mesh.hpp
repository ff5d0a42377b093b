// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace support {

/// What loading a mesh left out.
struct MeshDrops {
    std::uint64_t nonfinite_vertices = 0;      ///< vertices with a NaN or infinite coordinate
    std::uint64_t nonfinite_triangles = 0;     ///< faces that used one
    std::uint64_t out_of_range_triangles = 0;  ///< faces with an index beyond the vertices
    std::uint64_t degenerate_triangles = 0;    ///< triangles with two equal corners
    std::uint64_t unsplit_polygons = 0;        ///< polygons that cross themselves or take too long
    std::uint64_t points_and_lines = 0;        ///< faces with fewer than three corners
    std::uint64_t bytes_after_end = 0;         ///< bytes after all that the file declares

    /// The number of dropped faces, without points and lines.
    [[nodiscard]] std::uint64_t triangles() const {
        return nonfinite_triangles + out_of_range_triangles + degenerate_triangles +
               unsplit_polygons;
    }
    MeshDrops& operator+=(const MeshDrops& other);
};

/// " (dropped: 3 degenerate, 1 points or lines)"; empty if nothing was dropped.
[[nodiscard]] std::string dropped_text(const MeshDrops& drops);

/// The axis that points up in a file.
enum class UpAxis { unknown, x, y, z };

/// What a file says about the look of a surface.
struct MeshMaterial {
    std::string name;
    std::optional<glm::vec3> base_colour;  ///< linear RGB; nothing where the file does not say
    std::optional<float> opacity;          ///< 0 to 1; nothing where the file does not say
};

/// Indexed triangles with a normal at each vertex. Normals have length 1. The mean of a triangle's
/// normals points to the side from which its corners run counter-clockwise, except for normals that
/// clean_mesh() computed at sharp edges.
struct Mesh {
    std::vector<glm::vec3> positions;
    std::vector<glm::vec3> normals;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    /// Linear RGB and opacity of each vertex, factors of the material's; or empty.
    std::vector<glm::vec4> colours;
    std::vector<MeshMaterial> materials;
    /// Index into `materials` of each triangle; or empty.
    std::vector<std::uint32_t> triangle_materials;
    std::uint64_t ignored_textures = 0;  ///< textures that the file names and that are not drawn
    UpAxis up = UpAxis::unknown;         ///< of the file, where it has a convention
    MeshDrops drops;
    std::vector<std::string> notes;  ///< what else was left out, one line each, with its place
    /// The file ends within a line, so that it may have been cut off.
    bool ends_within_line = false;
};

/// Loads every mesh of a file: PLY, OBJ, glTF and GLB, OFF, STL, and the formats that Assimp reads.
/// Reads regular files of up to 1 GiB. Triangulates polygons, including concave ones. Merges
/// vertices with equal position, normal and colour, and leaves out unused ones. Computes smooth
/// normals where the file has none. Reverses triangles that disagree with the file's normals.
/// Throws InputError where the file is missing, not a regular file, unreadable, empty, damaged or
/// truncated, or has no triangle that can be drawn. The message is one line that names the file and
/// the place in it.
[[nodiscard]] Mesh load_mesh(const std::filesystem::path& path);

/// Merges equal vertices, leaves out vertices without a triangle, drops and counts triangles that
/// cannot be drawn, and computes missing normals (of length 0). Each triangle then starts at its
/// vertex with the lowest index. load_mesh() does this after reading; call it for meshes from
/// elsewhere.
[[nodiscard]] Mesh clean_mesh(const Mesh& mesh);

/// Moves the mesh to the origin and scales it so that its smallest enclosing sphere (to within a
/// few percent) has radius 1. Coordinates up to the largest float are safe.
void fit_to_unit_sphere(Mesh& mesh);

/// The same for several meshes in common coordinates: one translation and one scale for all.
void fit_to_unit_sphere(std::span<Mesh* const> meshes);

/// Turns the mesh so that the axis points along y. Handedness stays. UpAxis::unknown and y do
/// nothing.
void turn_up(Mesh& mesh, UpAxis axis);

}  // namespace support
