// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "device_types.hpp"
#include "scene.hpp"

namespace motion {

/// The sides of a triangle: SIDE_FRONT and SIDE_BACK of moving.clh.
constexpr cl_uchar side_front = 1, side_back = 2, both_sides = 3;

/// The sides of each triangle that the view can see. The inside of a closed surface is never
/// visible: its outside hides it at all times. A connected surface counts as closed if each edge
/// joins two triangles in opposite directions, its volume keeps its sign, and all of it stays in
/// front of the near plane. The triangles of other surfaces show both sides. Does not notice a part
/// of a surface that is inside out while the whole is not.
[[nodiscard]] std::vector<cl_uchar> seen_sides(const Scene& scene, const View& view);

}  // namespace motion
