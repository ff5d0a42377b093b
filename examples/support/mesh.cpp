// SPDX-License-Identifier: MIT
#include "mesh.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <string>
#include <unordered_map>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "mesh/raw_mesh.hpp"

namespace support {
namespace {

struct VertexKey {
    std::array<std::uint32_t, 10> bits;
    bool operator==(const VertexKey&) const = default;
};

struct VertexKeyHash {
    std::size_t operator()(const VertexKey& key) const {
        std::uint64_t hash = 0xCBF29CE484222325;
        for (const std::uint32_t word : key.bits) {
            hash = (hash ^ word) * 0x100000001B3;
            hash ^= hash >> 29;
        }
        return static_cast<std::size_t>(hash);
    }
};

VertexKey key_of(const glm::vec3& position, const glm::vec3& normal = glm::vec3(0),
                 const glm::vec4& colour = glm::vec4(0)) {
    VertexKey key{};
    std::size_t word = 0;
    // -0 and +0 are the same place.
    const auto add = [&](float value) {
        key.bits[word++] = std::bit_cast<std::uint32_t>(value + 0.0F);
    };
    for (int i = 0; i < 3; ++i) add(position[i]);
    for (int i = 0; i < 3; ++i) add(normal[i]);
    for (int i = 0; i < 4; ++i) add(colour[i]);
    return key;
}

// Area-weighted mean of the normals of the triangles around each place. Vertices that differ in
// colour share it.
std::vector<glm::dvec3> face_normals_by_vertex(const Mesh& mesh) {
    std::vector<std::uint32_t> place_of(mesh.positions.size());
    std::unordered_map<VertexKey, std::uint32_t, VertexKeyHash> places;
    double scale = 0;
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        const glm::vec3& p = mesh.positions[v];
        for (int i = 0; i < 3; ++i) scale = std::max(scale, std::abs(static_cast<double>(p[i])));
        place_of[v] = static_cast<std::uint32_t>(v);
        if (!mesh.colours.empty())
            place_of[v] = places.try_emplace(key_of(p), place_of[v]).first->second;
    }
    if (scale == 0) scale = 1;
    std::vector<glm::dvec3> sums(mesh.positions.size(), glm::dvec3(0));
    for (const auto& t : mesh.triangles) {
        const glm::dvec3 a = glm::dvec3(mesh.positions[t[0]]) / scale;
        const glm::dvec3 b = glm::dvec3(mesh.positions[t[1]]) / scale;
        const glm::dvec3 c = glm::dvec3(mesh.positions[t[2]]) / scale;
        const glm::dvec3 normal = glm::cross(b - a, c - a);
        for (const std::uint32_t vertex : t) sums[place_of[vertex]] += normal;
    }
    for (std::size_t v = 0; v < sums.size(); ++v) sums[v] = sums[place_of[v]];
    return sums;
}

void complete_normals(Mesh& mesh) {
    if (std::none_of(mesh.normals.begin(), mesh.normals.end(),
                     [](const glm::vec3& n) { return n == glm::vec3(0); }))
        return;
    const std::vector<glm::dvec3> sums = face_normals_by_vertex(mesh);
    for (std::size_t i = 0; i < sums.size(); ++i) {
        if (mesh.normals[i] != glm::vec3(0)) continue;
        const double length = glm::length(sums[i]);
        mesh.normals[i] = length > 0 ? glm::vec3(sums[i] / length) : glm::vec3(0, 1, 0);
    }
}

void turn_towards_normals(Mesh& mesh) {
    for (auto& t : mesh.triangles) {
        const glm::dvec3 a(mesh.positions[t[0]]), b(mesh.positions[t[1]]), c(mesh.positions[t[2]]);
        const glm::dvec3 corner_normals = glm::dvec3(mesh.normals[t[0]]) +
                                          glm::dvec3(mesh.normals[t[1]]) +
                                          glm::dvec3(mesh.normals[t[2]]);
        if (glm::dot(glm::cross(b - a, c - a), corner_normals) < 0) std::swap(t[1], t[2]);
    }
}

// Numbers the vertices that the mesh's triangles use, in the order of the source. Equal ones share
// a number.
void merge_vertices(const Mesh& source, Mesh& mesh) {
    std::vector<bool> used(source.positions.size(), false);
    for (const auto& t : mesh.triangles)
        for (const std::uint32_t vertex : t) used[vertex] = true;
    std::unordered_map<VertexKey, std::uint32_t, VertexKeyHash> merged;
    merged.reserve(source.positions.size());
    std::vector<std::uint32_t> renumbered(source.positions.size(), 0);
    for (std::size_t i = 0; i < source.positions.size(); ++i) {
        if (!used[i]) continue;
        const glm::vec3& position = source.positions[i];
        const bool has_normal = i < source.normals.size() && is_finite(source.normals[i]);
        const glm::vec3 normal = has_normal ? source.normals[i] : glm::vec3(0);
        glm::vec4 colour(1);
        if (i < source.colours.size())
            for (int k = 0; k < 4; ++k)
                if (std::isfinite(source.colours[i][k]))
                    colour[k] = std::clamp(source.colours[i][k], 0.0F, 1.0F);
        const auto [entry, is_new] = merged.try_emplace(
            key_of(position, normal, colour), static_cast<std::uint32_t>(mesh.positions.size()));
        if (is_new) {
            mesh.positions.push_back(position);
            mesh.normals.push_back(normal);
            if (!source.colours.empty()) mesh.colours.push_back(colour);
        }
        renumbered[i] = entry->second;
    }
    for (auto& t : mesh.triangles)
        for (std::uint32_t& vertex : t) vertex = renumbered[vertex];
}

}  // namespace

std::string dropped_text(const MeshDrops& drops) {
    std::string text;
    const auto add = [&](std::uint64_t count, const std::string& what) {
        if (count > 0) text += (text.empty() ? "" : ", ") + std::to_string(count) + " " + what;
    };
    add(drops.nonfinite_triangles, "with NaN or infinite vertices");
    add(drops.out_of_range_triangles, "with indices out of range");
    add(drops.degenerate_triangles, "degenerate");
    add(drops.unsplit_polygons, "polygons that cross themselves or are too complex");
    add(drops.points_and_lines, "points or lines");
    add(drops.bytes_after_end, "bytes after the end");
    return text.empty() ? "" : " (dropped: " + text + ")";
}

MeshDrops& MeshDrops::operator+=(const MeshDrops& other) {
    nonfinite_vertices += other.nonfinite_vertices;
    nonfinite_triangles += other.nonfinite_triangles;
    out_of_range_triangles += other.out_of_range_triangles;
    degenerate_triangles += other.degenerate_triangles;
    unsplit_polygons += other.unsplit_polygons;
    points_and_lines += other.points_and_lines;
    bytes_after_end += other.bytes_after_end;
    return *this;
}

Mesh clean_mesh(const Mesh& source) {
    Mesh mesh;
    mesh.drops = source.drops;
    mesh.ends_within_line = source.ends_within_line;
    mesh.materials = source.materials;
    mesh.ignored_textures = source.ignored_textures;
    mesh.up = source.up;
    mesh.notes = source.notes;
    for (const glm::vec3& position : source.positions)
        if (!is_finite(position)) ++mesh.drops.nonfinite_vertices;
    for (std::size_t i = 0; i < source.triangles.size(); ++i) {
        const auto& t = source.triangles[i];
        const auto& p = source.positions;
        if (t[0] >= p.size() || t[1] >= p.size() || t[2] >= p.size()) {
            ++mesh.drops.out_of_range_triangles;
        } else if (!is_finite(p[t[0]]) || !is_finite(p[t[1]]) || !is_finite(p[t[2]])) {
            ++mesh.drops.nonfinite_triangles;
        } else if (p[t[0]] == p[t[1]] || p[t[1]] == p[t[2]] || p[t[2]] == p[t[0]]) {
            ++mesh.drops.degenerate_triangles;
        } else {
            mesh.triangles.push_back(t);
            if (!source.triangle_materials.empty())
                mesh.triangle_materials.push_back(source.triangle_materials[i]);
        }
    }
    merge_vertices(source, mesh);
    // Only normals from the file reverse triangles. Normals that are computed here follow the
    // triangles.
    turn_towards_normals(mesh);
    complete_normals(mesh);
    // Coincident triangles then start at the same corner, whatever their winding, and the
    // rasteriser gives them equal depths to the last bit.
    for (auto& t : mesh.triangles)
        std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    return mesh;
}

void fit_to_unit_sphere(Mesh& mesh) {
    Mesh* const meshes[] = {&mesh};
    fit_to_unit_sphere(meshes);
}

void fit_to_unit_sphere(std::span<Mesh* const> meshes) {
    const auto for_each_position = [&](const auto& use) {
        for (Mesh* mesh : meshes)
            for (glm::vec3& p : mesh->positions) use(p);
    };
    // Steps towards the farthest vertex, each shorter than the one before (Badoiu and Clarkson
    // 2003).
    glm::dvec3 low(std::numeric_limits<double>::infinity()), high = -low;
    for_each_position([&](const glm::vec3& p) {
        low = glm::min(low, glm::dvec3(p));
        high = glm::max(high, glm::dvec3(p));
    });
    if (!(low.x <= high.x)) return;
    glm::dvec3 centre = 0.5 * (low + high);
    double radius = 0;
    for (int step = 1; step <= 64; ++step) {
        glm::dvec3 farthest = centre;
        radius = 0;
        for_each_position([&](const glm::vec3& p) {
            const double distance = glm::length(glm::dvec3(p) - centre);
            if (distance > radius) {
                radius = distance;
                farthest = p;
            }
        });
        if (step < 64) centre += (farthest - centre) / (step + 1.0);
    }
    const double scale = radius > 0 ? 1 / radius : 1;
    for_each_position([&](glm::vec3& p) { p = glm::vec3((glm::dvec3(p) - centre) * scale); });
}

void turn_up(Mesh& mesh, UpAxis axis) {
    const auto turn = [&](const auto& turned) {
        for (std::vector<glm::vec3>* vectors : {&mesh.positions, &mesh.normals})
            for (glm::vec3& v : *vectors) v = turned(v);
    };
    if (axis == UpAxis::x) turn([](const glm::vec3& v) { return glm::vec3(-v.y, v.x, v.z); });
    if (axis == UpAxis::z) turn([](const glm::vec3& v) { return glm::vec3(v.x, v.z, -v.y); });
}

}  // namespace support
