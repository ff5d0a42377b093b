// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "scene/scene.hpp"

namespace oit {

/// Adds a mesh to a scene, without moving it: a model for each material of its triangles.
///   alpha      opacity where neither the file nor `own_alpha` gives one; never makes a surface
///              opaque
///   own_alpha  opacity of all surfaces, whatever the file says; 1 makes opaque surfaces
void add_mesh(Scene& scene, support::Mesh mesh, float alpha, std::optional<float> own_alpha = {});

}  // namespace oit
