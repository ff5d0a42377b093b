// SPDX-License-Identifier: MIT
// Small scenes, each at a limit of what numbers can hold.
#include <cmath>
#include <limits>
#include <numbers>

#include "scene/scenes.hpp"

namespace oit {
namespace {

// Squares that face the eye of the view (0, 0).
class Squares {
public:
    void set_material(const Material& material) { scene_.materials.push_back(material); }

    // From (x, y) to (x + side, y + side), at z.
    void add(float x, float y, float side, float z) {
        support::Mesh mesh;
        for (const float down : {0.0F, side})
            for (const float across : {0.0F, side}) {
                mesh.positions.emplace_back(x + across, y + down, z);
                mesh.normals.emplace_back(0.0F, 0.0F, 1.0F);
            }
        mesh.triangles = {{0, 1, 3}, {0, 3, 2}};
        add(std::move(mesh));
    }
    void add(support::Mesh mesh) {
        scene_.models.push_back({.mesh = support::clean_mesh(mesh)});
        scene_.instances.push_back(
            {.model = scene_.models.size() - 1, .material = scene_.materials.size() - 1});
    }
    // The last mesh again, elsewhere.
    void repeat(const glm::dvec3& by) {
        Instance instance = scene_.instances.back();
        instance.to_world[3] = glm::dvec4(by, 1);
        scene_.instances.push_back(instance);
    }
    Scene take() { return std::move(scene_); }

private:
    Scene scene_;
};

constexpr float least_alpha = 0x1p-24F;

// Every opacity at an end of its range, over every other.
Scene alphas(float) {
    Squares squares;
    const float ends[] = {0, 1, least_alpha, 1 - least_alpha};
    for (int i = 0; i < 4; ++i) {
        squares.set_material(glass(ends[i]));
        const auto at = -0.6F + 0.3F * static_cast<float>(i);
        squares.add(at, -0.6F, 0.25F, 0.1F * static_cast<float>(i));
        squares.set_material(glass(ends[i]));
        squares.add(-0.6F, at, 1.0F, -0.3F - 0.1F * static_cast<float>(i));
    }
    return squares.take();
}

// 10,000 layers in some pixels.
Scene layers(float) {
    Squares squares;
    squares.set_material(glass(1e-3F));
    squares.add(-0.1F, -0.1F, 0.2F, 0);
    for (int i = 1; i < 10'000; ++i) squares.repeat({0, 0, -0.9 + 1.8e-4 * i});
    return squares.take();
}

// So much glass that the light that passes is less than any float.
Scene underflow(float) {
    Squares squares;
    squares.set_material(glass(0.9F));
    squares.add(-0.5F, -0.5F, 1, 0);
    for (int i = 1; i < 100; ++i) squares.repeat({0, 0, -0.9 + 0.018 * i});
    return squares.take();
}

// Colours of 10,000 behind and in front of dim ones.
Scene bright(float alpha) {
    Squares squares;
    for (int i = 0; i < 5; ++i) {
        Material material = glass(alpha);
        for (int c = 0; c < 3; ++c)
            material.front_tint[c] = material.back_tint[c] = i % 2 == 0 ? 1e4F : 1e-4F;
        squares.set_material(material);
        const auto at = 0.15F * static_cast<float>(i);
        squares.add(-0.6F + at, -0.6F + at, 0.6F, -at);
    }
    return squares.take();
}

// Squares in one plane, and the same square twice.
Scene coplanar(float alpha) {
    Squares squares;
    for (int i = 0; i < 3; ++i) {
        Material material = glass(alpha);
        material.front_tint[i] = 1;
        squares.set_material(material);
        const auto at = 0.2F * static_cast<float>(i);
        squares.add(-0.6F + at, -0.5F + at, 0.6F, 0);
        squares.repeat({0, 0, 0});
    }
    return squares.take();
}

// Triangles without width, smaller than a pixel, and larger than the screen.
Scene slivers(float alpha) {
    Squares squares;
    squares.set_material(glass(alpha));
    support::Mesh mesh;
    const auto add = [&](glm::vec3 a, glm::vec3 b, glm::vec3 c) {
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (const glm::vec3& p : {a, b, c}) {
            mesh.positions.push_back(p);
            mesh.normals.emplace_back(0.0F, 0.0F, 1.0F);
        }
        mesh.triangles.push_back({first, first + 1, first + 2});
    };
    for (int i = 0; i < 200; ++i) {
        const double angle = std::numbers::pi * i / 200;
        const glm::vec3 far(static_cast<float>(std::cos(angle)),
                            static_cast<float>(std::sin(angle)), 0.0F);
        add(-0.9F * far, 0.9F * far, 0.9F * far + glm::vec3(1e-3F, 1e-3F, 0));
        add(0.5F * far, 0.5F * far + glm::vec3(1e-4F, 0, 0), 0.5F * far + glm::vec3(0, 1e-4F, 0));
    }
    add({-100, -100, -0.5F}, {100, -100, -0.5F}, {0, 200, -0.5F});
    squares.add(std::move(mesh));
    return squares.take();
}

// Corners so far away that their products are near the largest float.
Scene far(float alpha) {
    Squares squares;
    squares.set_material(glass(alpha));
    squares.add(-1e30F, -1e30F, 2e30F, -0.5F);
    squares.add(-1e20F, 0, 1e20F, 0);
    squares.add(-0.3F, -0.3F, 0.6F, 0.2F);
    return squares.take();
}

// Vertices that are no numbers are left out, with the triangles around them.
Scene nan(float alpha) {
    Squares squares;
    squares.set_material(glass(alpha));
    support::Mesh mesh;
    for (int i = 0; i < 12; ++i) {
        const double angle = 2 * std::numbers::pi * i / 12;
        mesh.positions.emplace_back(static_cast<float>(0.7 * std::cos(angle)),
                                    static_cast<float>(0.7 * std::sin(angle)), 0.0F);
        mesh.normals.emplace_back(0.0F, 0.0F, 1.0F);
    }
    mesh.positions[3].x = std::numeric_limits<float>::quiet_NaN();
    mesh.positions[8].y = std::numeric_limits<float>::infinity();
    for (std::uint32_t i = 1; i + 1 < 12; ++i) mesh.triangles.push_back({0, i, i + 1});
    squares.add(std::move(mesh));
    return squares.take();
}

// Nothing at all, and nothing but opaque surfaces.
Scene nothing(float) { return {}; }

Scene opaque(float) {
    Squares squares;
    Material material = glass(1);
    material.blend = static_cast<cl_uint>(Blend::opaque);
    squares.set_material(material);
    squares.add(-0.5F, -0.5F, 1, 0);
    return squares.take();
}

const SceneRegistration registrations[]{
    SceneRegistration({"extreme-alphas", "opacities of 0, 2^-24, 1 - 2^-24 and 1", alphas, false}),
    SceneRegistration({"extreme-layers", "10,000 layers", layers, false}),
    SceneRegistration(
        {"extreme-underflow", "glass that lets 10^-100 of the light pass", underflow, false}),
    SceneRegistration({"extreme-bright", "colours of 10^4 and 10^-4", bright}),
    SceneRegistration({"extreme-coplanar", "surfaces at one depth", coplanar}),
    SceneRegistration(
        {"extreme-slivers", "triangles thinner than a pixel, and of any size", slivers}),
    SceneRegistration({"extreme-far", "corners at 10^30", far}),
    SceneRegistration({"extreme-nan", "NaN vertices", nan}),
    SceneRegistration({"extreme-nothing", "no surfaces", nothing, false}),
    SceneRegistration({"extreme-opaque", "no transparent surfaces", opaque, false}),
};

}  // namespace
}  // namespace oit
