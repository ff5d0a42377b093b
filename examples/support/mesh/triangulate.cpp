// SPDX-License-Identifier: MIT
#include "triangulate.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include <glm/geometric.hpp>

#include "polygon.hpp"

namespace support {
namespace {}  // namespace

Mesh triangulate(RawMesh raw) {
    Mesh mesh;
    mesh.drops = raw.drops;
    PolygonSplitter splitter;
    std::vector<glm::vec3> places;
    std::vector<PolygonSplitter::Triangle> parts;
    std::size_t begin = 0;
    for (std::size_t f = 0; f < raw.face_ends.size(); ++f) {
        const std::size_t end = raw.face_ends[f];
        const auto corners = std::span(raw.corners).subspan(begin, end - begin);
        begin = end;
        if (corners.size() < 3) {
            ++mesh.drops.points_and_lines;
            continue;
        }
        if (std::any_of(corners.begin(), corners.end(),
                        [&](std::uint32_t v) { return v >= raw.positions.size(); })) {
            ++mesh.drops.out_of_range_triangles;
            continue;
        }
        if (!std::all_of(corners.begin(), corners.end(),
                         [&](std::uint32_t v) { return is_finite(raw.positions[v]); })) {
            ++mesh.drops.nonfinite_triangles;
            continue;
        }
        parts.clear();
        auto result = PolygonSplitter::Result::split;
        if (corners.size() == 3) {
            parts.push_back({0, 1, 2});
        } else {
            places.clear();
            for (const std::uint32_t v : corners) places.push_back(raw.positions[v]);
            result = splitter.split(places, parts);
        }
        if (result == PolygonSplitter::Result::flat)
            ++mesh.drops.degenerate_triangles;
        else if (result != PolygonSplitter::Result::split)
            ++mesh.drops.unsplit_polygons;
        for (const auto& part : parts) {
            mesh.triangles.push_back({corners[part[0]], corners[part[1]], corners[part[2]]});
            if (!raw.face_materials.empty())
                mesh.triangle_materials.push_back(raw.face_materials[f]);
        }
    }
    mesh.positions = std::move(raw.positions);
    mesh.normals = std::move(raw.normals);
    for (glm::vec3& normal : mesh.normals) {
        const double length = glm::length(glm::dvec3(normal));
        normal = length > 0 && std::isfinite(length) ? glm::vec3(glm::dvec3(normal) / length)
                                                     : glm::vec3(0);
    }
    mesh.colours = std::move(raw.colours);
    mesh.materials = std::move(raw.materials);
    mesh.ignored_textures = raw.ignored_textures;
    mesh.up = raw.up;
    mesh.notes = std::move(raw.notes);
    mesh.ends_within_line = raw.ends_within_line;
    return mesh;
}

}  // namespace support
