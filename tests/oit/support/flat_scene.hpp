// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "methods/renderer.hpp"
#include "oit/support/screen.hpp"
#include "scene/scene.hpp"
#include "support/device.hpp"

namespace cellist::test {

/// A scene whose surfaces are as bright as their tints, before a background of `background`.
inline oit::Scene flat_scene(float background) {
    oit::Scene scene;
    for (int c = 0; c < 3; ++c) {
        scene.lighting.sky[c] = scene.lighting.ground[c] = 1;
        scene.lighting.key[c] = scene.lighting.rim[c] = 0;
        scene.lighting.background_top[c] = scene.lighting.background_bottom[c] = background;
    }
    return scene;
}

/// Adds a mesh with a material of its own, of these tints in front and behind.
inline void add_model(oit::Scene& scene, const support::Mesh& mesh, oit::Blend blend, float alpha,
                      const std::array<float, 3>& front, const std::array<float, 3>& back) {
    oit::Material material{};
    std::ranges::copy(front, material.front_tint);
    std::ranges::copy(back, material.back_tint);
    material.alpha = alpha;
    material.blend = static_cast<cl_uint>(blend);
    scene.instances.push_back({.model = scene.models.size(), .material = scene.materials.size()});
    scene.models.push_back({.mesh = mesh});
    scene.materials.push_back(material);
}

/// As pixel_view, with rays, which shading needs.
inline raster::View shaded_pixel_view(int width, int height) {
    raster::View view = pixel_view(width, height);
    view.ray_origin[2] = 1;
    return view;
}

inline std::vector<cl_float4> drawn(const oit::Frame& frame,
                                    const oit::MethodInfo& method = oit::method_named("linked")) {
    oit::Renderer renderer(device(), frame, method);
    renderer.draw();
    return renderer.image();
}

}  // namespace cellist::test
