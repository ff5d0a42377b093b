// SPDX-License-Identifier: MIT
#include "scene.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/trigonometric.hpp>

#include "build.hpp"
#include "image.hpp"
#include "input_error.hpp"

namespace motion {
namespace {

const glm::dvec3 x_axis(1, 0, 0), y_axis(0, 1, 0);

glm::dmat4 moved(const glm::dvec3& by) { return glm::translate(glm::dmat4(1), by); }

glm::dmat4 turned(double degrees, const glm::dvec3& axis) {
    return glm::rotate(glm::dmat4(1), glm::radians(degrees), axis);
}

glm::dmat4 scaled(const glm::dvec3& size) { return glm::scale(glm::dmat4(1), size); }

// A blade of a fan along x that is twisted and rounded at its tip.
Shape make_blade() {
    Shape blade = make_box({40, 2, 12});
    for (glm::dvec3& p : blade.positions) {
        const double along = p.x + 0.5;
        // The last tenth becomes narrower.
        const double tip = std::max(0.0, (along - 0.9) / 0.1);
        const double chord = (0.16 + 0.1 * along) * (1 - 0.7 * tip * tip);
        const glm::dvec4 section =
            turned(28 - 14 * along, x_axis) * glm::dvec4(0, 0.014 * p.y, chord * p.z, 0);
        p = {0.07 + 0.73 * along, section.y, section.z};
    }
    return blade;
}

// The colour of a triangle of a mesh as the file says, or that of clay.
glm::u8vec4 colour_of(const support::Mesh& mesh, std::size_t triangle) {
    glm::dvec3 linear = mesh.colours.empty() ? glm::dvec3(0.55, 0.42, 0.32) : glm::dvec3(1);
    if (!mesh.triangle_materials.empty()) {
        const support::MeshMaterial& material = mesh.materials[mesh.triangle_materials[triangle]];
        if (material.base_colour) linear = glm::dvec3(*material.base_colour);
    }
    if (!mesh.colours.empty()) {
        glm::dvec3 sum(0);
        for (const std::uint32_t vertex : mesh.triangles[triangle])
            sum += glm::dvec3(mesh.colours[vertex]);
        linear *= sum / 3.0;
    }
    glm::u8vec4 colour(255);
    for (int i = 0; i < 3; ++i)
        colour[i] =
            static_cast<std::uint8_t>(std::lround(255 * support::srgb_from_linear(linear[i])));
    return colour;
}

// A box with its sides along the axes.
struct Bounds {
    glm::dvec3 low{std::numeric_limits<double>::infinity()};
    glm::dvec3 high{-std::numeric_limits<double>::infinity()};

    void add(const glm::dvec3& p) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    [[nodiscard]] glm::dvec3 middle() const { return 0.5 * (low + high); }
    [[nodiscard]] glm::dvec3 size() const { return high - low; }
};

}  // namespace

Scene make_cubes() {
    Scene scene;
    scene.name = "cubes";
    add_ground(scene, {0, 0}, {3.2, 2.4}, {40, 30});
    const Shape cube = make_box(glm::ivec3(20));
    const glm::dmat4 up = moved({0, 0.4, 0});
    // The upper cube shades a part of the lower one.
    const glm::dmat4 lower =
        moved({-0.3, 0.42, 0.05}) * turned(25, y_axis) * scaled(glm::dvec3(0.62));
    const glm::dmat4 upper =
        moved({0.14, 1.12, -0.08}) * turned(-15, y_axis) * scaled(glm::dvec3(0.46));
    add(scene, cube, lower, up * lower, {205, 92, 60, 255});
    add(scene, cube, upper, up * upper, {70, 120, 185, 255});
    aim_light(scene, {0.35, 3.6, 0.3}, {0, 0.6, 0});
    scene.eye = {2.2, 2.5, 3.4};
    scene.target = {0, 0.62, 0};
    scene.field_degrees = 36;
    return scene;
}

Scene make_fan() {
    Scene scene;
    scene.name = "fan";
    add_ground(scene, {0, 0}, {2.6, 2.6});
    const glm::dvec3 centre(0, 0.75, 0);
    const glm::dmat4 place = moved(centre);
    const glm::dmat4 spin = place * turned(75, y_axis);
    constexpr int blades = 4;
    for (int i = 0; i < blades; ++i) {
        const glm::dmat4 blade = turned(360.0 * i / blades, y_axis);
        add(scene, make_blade(), place * blade, spin * blade, {60, 130, 170, 255});
    }
    const std::array<glm::dvec2, 6> hub{
        {{0, 0.07}, {0.06, 0.06}, {0.1, 0.03}, {0.1, -0.05}, {0.09, -0.06}, {0, -0.06}}};
    add(scene, make_lathe(hub, 48), place, spin, {215, 170, 70, 255});
    const std::array<glm::dvec2, 8> stand{{{0, 0.72},
                                           {0.02, 0.72},
                                           {0.02, 0.5},
                                           {0.02, 0.25},
                                           {0.025, 0.05},
                                           {0.22, 0.03},
                                           {0.23, 0.002},
                                           {0, 0.002}}};
    add(scene, make_lathe(stand, 48), glm::dmat4(1), {90, 90, 95, 255});
    aim_light(scene, {0.7, 3.4, 0.5}, {0, 0.5, 0});
    scene.eye = {1.9, 2.1, 2.9};
    scene.target = {0, 0.32, 0};
    scene.field_degrees = 35;
    return scene;
}

Scene make_blinds() {
    Scene scene;
    scene.name = "blinds";
    add_ground(scene, {0, 0}, {2.6, 2});
    add(scene, make_square(glm::ivec2(32)),
        moved({0, 0.85, -1}) * turned(90, x_axis) * scaled({2.6, 1, 1.7}), {196, 200, 206, 255});
    const Shape slat = make_box({2, 40, 6});
    for (int i = 0; i < 6; ++i) {
        const glm::dmat4 place =
            moved({-0.9 + 0.28 * i, 0.8, 0.1}) * turned(55, y_axis) * scaled({0.012, 1.2, 0.16});
        add(scene, slat, place, moved({0.28, 0, 0}) * place, {200, 85, 60, 255});
    }
    const glm::dmat4 lying = turned(90, {0, 0, 1});
    for (int i = 0; i < 5; ++i) {
        const glm::dmat4 place = moved({0, 0.2 + 0.25 * i, -0.4}) * turned(-35, x_axis) * lying *
                                 scaled({0.012, 1.7, 0.15});
        add(scene, slat, place, moved({0, 0.2, 0}) * place, {75, 125, 175, 255});
    }
    aim_light(scene, {-0.7, 1.9, 3.2}, {0, 0.7, -0.4});
    scene.eye = {0.7, 1.4, 3.7};
    scene.target = {0, 0.72, -0.35};
    scene.field_degrees = 36;
    return scene;
}

Scene make_mesh_scene(const support::Mesh& mesh, const RigidMotion& motion) {
    if (mesh.triangles.empty()) throw support::InputError("the mesh has no triangle");
    constexpr double farthest = 10;
    for (int i = 0; i < 3; ++i)
        if (!(std::abs(motion.move[i]) <= farthest))
            throw support::InputError("the mesh moves by " + std::to_string(motion.move[i]) +
                                      " m: give -10 to 10 m along each axis");
    if (!(std::abs(motion.spin_degrees) <= 360))
        throw support::InputError("the mesh spins by " + std::to_string(motion.spin_degrees) +
                                  " degrees: give -360 to 360");
    Bounds bounds;
    for (const glm::vec3& p : mesh.positions) {
        if (!std::isfinite(double(p.x) + double(p.y) + double(p.z)))
            throw support::InputError("a vertex of the mesh is not finite");
        bounds.add(glm::dvec3(p));
    }
    const glm::dvec3 size = bounds.size();
    const double largest = std::max({size.x, size.y, size.z});
    if (!(largest > 0)) throw support::InputError("the mesh has no size");

    Shape shape;
    for (const glm::vec3& p : mesh.positions)
        shape.positions.push_back((glm::dvec3(p) - bounds.middle()) / largest);
    for (const auto& t : mesh.triangles) shape.triangles.emplace_back(t[0], t[1], t[2]);
    // Nothing moves below the ground.
    const double lift = 0.5 * size.y / largest + std::max(0.0, -motion.move.y);
    const glm::dmat4 begin = moved({0, lift, 0});
    const glm::dmat4 end = moved(motion.move) * begin * turned(motion.spin_degrees, y_axis);
    Bounds sweep;
    for (const glm::dvec3& p : shape.positions)
        for (const glm::dmat4& place : {begin, end})
            sweep.add(glm::dvec3(place * glm::dvec4(p, 1)));

    Scene scene;
    scene.name = "mesh";
    const glm::dvec3 middle = sweep.middle();
    const double radius = 0.5 * glm::length(sweep.size());
    add_ground(scene, {middle.x, middle.z},
               glm::dvec2(sweep.size().x, sweep.size().z) + 2.5 * radius);
    const std::size_t ground = scene.triangles.size();
    add(scene, shape, begin, end, glm::u8vec4(255));
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
        scene.colours[ground + i] = colour_of(mesh, i);
    aim_light(scene, middle + 4.5 * radius * glm::normalize(glm::dvec3(-0.45, 1, 0.5)), middle);
    scene.field_degrees = 36;
    scene.target = middle - glm::dvec3(0, 0.2 * radius, 0);
    scene.eye = scene.target + 4.2 * radius * glm::normalize(glm::dvec3(0.6, 0.55, 1));
    return scene;
}

}  // namespace motion
