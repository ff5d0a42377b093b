// SPDX-License-Identifier: MIT
#include "build.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "input_error.hpp"
#include "number_text.hpp"

namespace motion {
namespace {

// The directions of the image of a light: the same as those of support::look_at().
struct Axes {
    explicit Axes(const glm::dvec3& axis)
        : forward(axis),
          right(glm::normalize(glm::cross(
              forward, std::abs(axis.y) >= 0.999 ? glm::dvec3(0, 0, 1) : glm::dvec3(0, 1, 0)))),
          down(glm::cross(forward, right)) {}

    [[nodiscard]] glm::dvec2 across(const glm::dvec3& ray) const {
        return {glm::dot(ray, right), glm::dot(ray, down)};
    }

    glm::dvec3 forward, right, down;
};

}  // namespace

Shape make_box(const glm::ivec3& cells) {
    Shape shape;
    std::map<std::array<int, 3>, std::uint32_t> vertices;
    const auto vertex = [&](const glm::ivec3& corner) {
        const auto [found, is_new] =
            vertices.try_emplace({corner.x, corner.y, corner.z}, shape.positions.size());
        if (is_new) shape.positions.push_back(glm::dvec3(corner) / glm::dvec3(cells) - 0.5);
        return found->second;
    };
    for (int axis = 0; axis < 3; ++axis) {
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        for (const bool far : {false, true})
            for (int j = 0; j < cells[v]; ++j)
                for (int i = 0; i < cells[u]; ++i) {
                    const auto at = [&](int di, int dj) {
                        glm::ivec3 corner;
                        corner[axis] = far ? cells[axis] : 0;
                        corner[u] = i + di;
                        corner[v] = j + dj;
                        return vertex(corner);
                    };
                    const std::uint32_t a = at(0, 0), c = at(1, 1);
                    std::uint32_t b = at(1, 0), d = at(0, 1);
                    if (!far) std::swap(b, d);
                    shape.triangles.emplace_back(a, b, c);
                    shape.triangles.emplace_back(a, c, d);
                }
    }
    return shape;
}

Shape make_lathe(std::span<const glm::dvec2> profile, int segments) {
    Shape shape;
    shape.positions = {{0, profile.front().y, 0}, {0, profile.back().y, 0}};
    const std::span<const glm::dvec2> rings = profile.subspan(1, profile.size() - 2);
    for (const glm::dvec2& ring : rings)
        for (int i = 0; i < segments; ++i) {
            const double angle = 2 * std::numbers::pi * i / segments;
            shape.positions.emplace_back(ring.x * std::sin(angle), ring.y,
                                         ring.x * std::cos(angle));
        }
    const auto at = [&](std::size_t ring, int i) {
        return static_cast<std::uint32_t>(2 + ring * static_cast<std::size_t>(segments) +
                                          static_cast<std::size_t>(i % segments));
    };
    for (int i = 0; i < segments; ++i) {
        shape.triangles.emplace_back(0, at(0, i), at(0, i + 1));
        for (std::size_t ring = 0; ring + 1 < rings.size(); ++ring) {
            shape.triangles.emplace_back(at(ring, i), at(ring + 1, i), at(ring + 1, i + 1));
            shape.triangles.emplace_back(at(ring, i), at(ring + 1, i + 1), at(ring, i + 1));
        }
        shape.triangles.emplace_back(1, at(rings.size() - 1, i + 1), at(rings.size() - 1, i));
    }
    return shape;
}

Shape make_square(const glm::ivec2& cells) {
    Shape shape;
    for (int z = 0; z <= cells.y; ++z)
        for (int x = 0; x <= cells.x; ++x)
            shape.positions.emplace_back(double(x) / cells.x - 0.5, 0, double(z) / cells.y - 0.5);
    for (int z = 0; z < cells.y; ++z)
        for (int x = 0; x < cells.x; ++x) {
            const auto a = static_cast<std::uint32_t>(z * (cells.x + 1) + x);
            const std::uint32_t b = a + 1, d = a + static_cast<std::uint32_t>(cells.x) + 1;
            shape.triangles.emplace_back(a, d, d + 1);
            shape.triangles.emplace_back(a, d + 1, b);
        }
    return shape;
}

void add(Scene& scene, const Shape& shape, const glm::dmat4& begin, const glm::dmat4& end,
         const glm::u8vec4& colour) {
    const auto first = static_cast<std::uint32_t>(scene.begin.size());
    for (const glm::dvec3& p : shape.positions) {
        scene.begin.emplace_back(glm::dvec3(begin * glm::dvec4(p, 1)));
        scene.end.emplace_back(glm::dvec3(end * glm::dvec4(p, 1)));
    }
    for (const glm::uvec3& triangle : shape.triangles) scene.triangles.push_back(first + triangle);
    scene.colours.resize(scene.triangles.size(), colour);
}

void add(Scene& scene, const Shape& shape, const glm::dmat4& place, const glm::u8vec4& colour) {
    add(scene, shape, place, place, colour);
}

void add_ground(Scene& scene, const glm::dvec2& centre, const glm::dvec2& size,
                const glm::ivec2& cells) {
    const glm::dmat4 place = glm::translate(glm::dmat4(1), {centre.x, 0, centre.y});
    add(scene, make_square(cells), glm::scale(place, {size.x, 1, size.y}), {205, 202, 196, 255});
}

void aim_light(Scene& scene, const glm::dvec3& position, const glm::dvec3& centre) {
    const double distance = glm::length(centre - position);
    glm::dvec3 forward = glm::normalize(centre - position);
    constexpr double bright_part = 0.89;  // of the disc of a spot light, without its faded rim
    double half_field = 0;                // tangent
    for (int round = 0; round < 8; ++round) {
        const Axes axes(forward);
        glm::dvec2 low(1e9), high(-1e9);
        half_field = 0;
        for (std::size_t i = 0; i < scene.begin.size(); ++i)
            for (const glm::vec3& p : {scene.begin[i], scene.end[i]}) {
                const glm::dvec3 ray = glm::dvec3(p) - position;
                const glm::dvec2 on_map = axes.across(ray) / glm::dot(ray, forward);
                low = glm::min(low, on_map);
                high = glm::max(high, on_map);
                half_field = std::max({half_field, std::abs(on_map.x), std::abs(on_map.y)});
                if (scene.begin[i] != scene.end[i])
                    half_field = std::max(half_field, glm::length(on_map) / bright_part);
            }
        scene.light.target = position + distance * forward;
        const glm::dvec2 middle = 0.5 * (low + high);
        forward = glm::normalize(forward + middle.x * axes.right + middle.y * axes.down);
    }
    scene.light.is_spot = true;
    scene.light.position = position;
    scene.light.field_degrees = 2 * std::atan(1.01 * half_field) * 180 / std::numbers::pi;
    scene.light.intensity = glm::vec3(glm::dvec3(std::numbers::pi * distance * distance));
}

void expose(Scene& scene, double exposure) {
    for (std::size_t i = 0; i < scene.begin.size(); ++i)
        scene.end[i] =
            glm::vec3(glm::mix(glm::dvec3(scene.begin[i]), glm::dvec3(scene.end[i]), exposure));
    if (exposure <= 1) return;
    const support::Light light = scene.light;
    const glm::dvec3 forward = glm::normalize(light.target - light.position);
    for (const glm::vec3& p : scene.end)
        if (!(glm::dot(glm::dvec3(p) - light.position, forward) > 0))
            throw support::InputError("--exposure " + support::shortest(exposure) +
                                      ": the scene moves past its light: give a smaller value");
    aim_light(scene, light.position, light.target);
}

void make_light_parallel(Scene& scene) {
    support::Light& light = scene.light;
    const Axes axes(glm::normalize(light.target - light.position));
    glm::dvec2 low(1e9), high(-1e9);
    for (const auto* positions : {&scene.begin, &scene.end})
        for (const glm::vec3& p : *positions) {
            const glm::dvec2 on_map = axes.across(glm::dvec3(p) - light.position);
            low = glm::min(low, on_map);
            high = glm::max(high, on_map);
        }
    const glm::dvec2 middle = 0.5 * (low + high);
    const glm::dvec3 move = middle.x * axes.right + middle.y * axes.down;
    light.is_spot = false;
    light.position += move;
    light.target += move;
    light.side = 1.01 * std::max(high.x - low.x, high.y - low.y);
    light.intensity = glm::vec3(static_cast<float>(std::numbers::pi));
}

}  // namespace motion
