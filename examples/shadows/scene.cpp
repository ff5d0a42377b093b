// SPDX-License-Identifier: MIT
#include "scene.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <tuple>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

namespace shadows {
namespace {

constexpr double pi = std::numbers::pi;

// A mesh over a grid of two parameters from 0 to 1, which wrap around where `closed` says so.
support::Mesh surface(int columns, int rows, bool closed_rows,
                      const std::function<glm::dvec3(double, double)>& point) {
    support::Mesh mesh;
    const int lines = closed_rows ? rows : rows + 1;
    for (int j = 0; j < lines; ++j)
        for (int i = 0; i < columns; ++i)
            mesh.positions.emplace_back(point(double(i) / columns, double(j) / rows));
    const auto at = [&](int i, int j) {
        return static_cast<std::uint32_t>((closed_rows ? j % rows : j) * columns + i % columns);
    };
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < columns; ++i) {
            mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    mesh.normals.assign(mesh.positions.size(), glm::vec3(0));
    return support::clean_mesh(mesh);
}

// A cube around the origin with sides of length 1.
support::Mesh box() {
    support::Mesh mesh;
    for (int axis = 0; axis < 3; ++axis)
        for (const float side : {-0.5F, 0.5F}) {
            const auto first = static_cast<std::uint32_t>(mesh.positions.size());
            for (int corner = 0; corner < 4; ++corner) {
                glm::vec3 p(side);
                p[(axis + 1) % 3] = corner % 2 == 0 ? -0.5F : 0.5F;
                p[(axis + 2) % 3] = corner / 2 == 0 ? -0.5F : 0.5F;
                glm::vec3 n(0);
                n[axis] = side > 0 ? 1.0F : -1.0F;
                mesh.positions.push_back(p);
                mesh.normals.push_back(n);
            }
            const std::uint32_t a = first, b = first + 1, c = first + 3, d = first + 2;
            if (side > 0) {
                mesh.triangles.push_back({a, b, c});
                mesh.triangles.push_back({a, c, d});
            } else {
                mesh.triangles.push_back({a, c, b});
                mesh.triangles.push_back({a, d, c});
            }
        }
    return mesh;
}

support::Mesh sphere() {
    return surface(64, 32, false, [](double u, double v) {
        const double around = 2 * pi * u, down = pi * v;
        // The poles are single points.
        const double radius = v == 0 || v == 1 ? 0 : std::sin(down);
        return glm::dvec3(radius * std::cos(around), std::cos(down), -radius * std::sin(around)) +
               0.0;
    });
}

// A ring of 784 triangles.
support::Mesh ring() {
    return surface(28, 14, true, [](double u, double v) {
        const double around = 2 * pi * u, tube = 2 * pi * v;
        const double radius = 1 + 0.35 * std::cos(tube);
        return glm::dvec3(radius * std::cos(around), radius * std::sin(around),
                          0.35 * std::sin(tube));
    });
}

glm::dmat4 placed(const glm::dvec3& centre, const glm::dvec3& size) {
    return glm::scale(glm::translate(glm::dmat4(1), centre), size);
}

// A square around the origin with sides of length 1, in the plane of x and y. Of many triangles: on
// GPUs, the rasteriser shares out a triangle of many pixels over one work-group only.
support::Mesh square() {
    constexpr std::uint32_t n = 16;
    support::Mesh mesh;
    for (std::uint32_t y = 0; y <= n; ++y)
        for (std::uint32_t x = 0; x <= n; ++x)
            mesh.positions.emplace_back(static_cast<float>(x) / n - 0.5F,
                                        static_cast<float>(y) / n - 0.5F, 0);
    mesh.normals.assign(mesh.positions.size(), glm::vec3(0, 0, 1));
    for (std::uint32_t y = 0; y < n; ++y)
        for (std::uint32_t x = 0; x < n; ++x) {
            const std::uint32_t a = y * (n + 1) + x, b = a + 1, c = a + n + 1, d = c + 1;
            mesh.triangles.push_back({a, b, d});
            mesh.triangles.push_back({a, d, c});
        }
    return mesh;
}

constexpr glm::dvec3 half_room(1.5, 1, 1);

// Floor, ceiling, back and sides; the front is open.
Scene empty_room() {
    Scene scene;
    scene.meshes.push_back(square());
    const auto wall = [&](int axis, double sign, const glm::vec3& albedo) {
        // The columns: two sides of the wall, its normal into the room, and its middle.
        glm::dmat4 place(0);
        place[0][(axis + 1) % 3] = 2 * half_room[(axis + 1) % 3];
        place[1][(axis + 2) % 3] = -2 * sign * half_room[(axis + 2) % 3];
        place[2][axis] = -sign;
        place[3][axis] = sign * half_room[axis];
        place[3][3] = 1;
        scene.instances.push_back({.to_world = place, .albedo = albedo});
    };
    wall(1, -1, {0.7F, 0.7F, 0.7F});
    wall(1, 1, {0.7F, 0.7F, 0.7F});
    wall(2, -1, {0.7F, 0.7F, 0.75F});
    wall(0, -1, {0.25F, 0.4F, 0.7F});
    wall(0, 1, {0.85F, 0.45F, 0.2F});
    scene.light = {.position = {-0.1, 0.85, 0.7},
                   .target = {1.5, -0.25, -0.1},
                   .field_degrees = 62,
                   .intensity = {24, 24, 23}};
    scene.eye = {0, 0.1, 4.1};
    scene.target = {0, 0, 0};
    scene.field_degrees = 35;
    return scene;
}

}  // namespace

std::size_t triangle_count(const Scene& scene) {
    std::size_t count = 0;
    for (const Instance& instance : scene.instances)
        count += scene.meshes[instance.mesh].triangles.size();
    return count;
}

support::Light make_parallel_light() {
    return {.is_spot = false,
            .position = {-0.6, 0.9, 3},
            .target = {1.0, -0.4, -0.3},
            .side = 1.2,
            .intensity = {8, 8, 7.7F}};
}

Scene make_room() {
    Scene scene = empty_room();
    scene.meshes.push_back(sphere());
    scene.instances.push_back({.mesh = 1,
                               .to_world = placed({-0.75, -0.45, -0.35}, glm::dvec3(0.55)),
                               .albedo = {0.8F, 0.8F, 0.8F},
                               .blocks = true});
    scene.meshes.push_back(box());
    for (int bar = 0; bar < 4; ++bar)
        scene.instances.push_back(
            {.mesh = 2,
             .to_world = placed({0.25, -0.35, -0.8 + 0.4 * bar}, {0.08, 1.3, 0.2}),
             .albedo = {0.6F, 0.6F, 0.55F},
             .blocks = true});
    return scene;
}

Scene make_swarm(std::size_t triangles) {
    Scene scene = empty_room();
    scene.meshes.push_back(ring());
    const std::size_t rings =
        std::max<std::size_t>(1, triangles / scene.meshes[1].triangles.size());
    const std::size_t first = scene.instances.size();
    for (std::size_t i = 0; i < rings; ++i)
        scene.instances.push_back({.mesh = 1, .albedo = {0.75F, 0.72F, 0.65F}, .blocks = true});
    scene.low = -half_room;
    scene.high = half_room;
    scene.move = [first](Scene& moved, double seconds) {
        const std::size_t count = moved.instances.size() - first;
        for (std::size_t i = 0; i < count; ++i) {
            // Each ring circles at its own place and speed, spread by irrational numbers.
            const auto spread = [&](double by) {
                const double x = static_cast<double>(i + 1) * by;
                return x - std::floor(x);
            };
            const double angle =
                2 * pi * (spread(0.618034) + (0.05 + 0.1 * spread(0.7549)) * seconds);
            const double radius = 0.15 + 0.75 * std::sqrt(spread(0.5698));
            const glm::dvec3 centre(-0.3 + 0.95 * radius * std::cos(angle),
                                    -0.8 + 1.4 * spread(0.3247) + 0.05 * std::sin(3 * angle),
                                    0.85 * radius * std::sin(angle));
            glm::dmat4 place = glm::translate(glm::dmat4(1), centre);
            place = glm::rotate(place, 2 * pi * spread(0.4142) + 2 * seconds,
                                glm::normalize(glm::dvec3(spread(0.7320) - 0.5, 1, spread(0.236))));
            moved.instances[first + i].to_world = glm::scale(place, glm::dvec3(0.06));
        }
    };
    scene.move(scene, 0);
    return scene;
}

Scene make_mesh_room(support::Mesh mesh) {
    Scene scene = empty_room();
    support::fit_to_unit_sphere(mesh);
    double lowest = 0;
    for (const glm::vec3& p : mesh.positions) lowest = std::min(lowest, static_cast<double>(p.y));
    constexpr double size = 0.85;
    scene.meshes.push_back(std::move(mesh));
    scene.instances.push_back(
        {.mesh = 1,
         .to_world = placed({-0.25, -half_room.y - size * lowest, -0.1}, glm::dvec3(size)),
         .albedo = {0.75F, 0.75F, 0.72F},
         .blocks = true});
    return scene;
}

support::Mesh simplify(const support::Mesh& mesh, int cells) {
    glm::vec3 low(mesh.positions.empty() ? glm::vec3(0) : mesh.positions.front()), high(low);
    for (const glm::vec3& p : mesh.positions) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    const glm::vec3 size = high - low;
    const float side = std::max({size.x, size.y, size.z}) / static_cast<float>(cells);
    if (!(side > 0)) return mesh;
    struct Merged {
        glm::dvec3 sum{0};
        double count = 0;
        std::uint32_t index = 0;
    };
    std::map<std::tuple<int, int, int>, Merged> cubes;
    std::vector<Merged*> of_vertex;
    for (const glm::vec3& p : mesh.positions) {
        const glm::ivec3 cube = glm::min(glm::ivec3((p - low) / side), cells - 1);
        Merged& merged = cubes[{cube.x, cube.y, cube.z}];
        merged.sum += glm::dvec3(p);
        merged.count += 1;
        of_vertex.push_back(&merged);
    }
    support::Mesh coarse;
    for (auto& [cube, merged] : cubes) {
        merged.index = static_cast<std::uint32_t>(coarse.positions.size());
        coarse.positions.emplace_back(merged.sum / merged.count);
    }
    for (const auto& triangle : mesh.triangles) {
        std::array<std::uint32_t, 3> merged{};
        for (std::size_t k = 0; k < 3; ++k) merged[k] = of_vertex[triangle[k]]->index;
        if (merged[0] != merged[1] && merged[1] != merged[2] && merged[2] != merged[0])
            coarse.triangles.push_back(merged);
    }
    coarse.normals.assign(coarse.positions.size(), glm::vec3(0));
    return coarse.triangles.empty() ? coarse : support::clean_mesh(coarse);
}

}  // namespace shadows
