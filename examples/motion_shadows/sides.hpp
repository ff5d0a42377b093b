#pragma once

#include <vector>

#include "device_types.hpp"
#include "scene.hpp"

namespace motion {

/// A side of a triangle: SIDE_FRONT and SIDE_BACK of moving.clh.
constexpr cl_uchar side_front = 1, side_back = 2, both_sides = 3;

/// The sides of each triangle that the view can see. Of a closed surface, the insides never show:
/// what hides them lies in front of them at all times. Counts a connected surface as closed if each
/// edge joins two triangles in opposite directions, and it does not turn inside out, and lies in
/// front of the near plane at all times; triangles of others show both sides.
[[nodiscard]] std::vector<cl_uchar> seen_sides(const Scene& scene, const View& view);

}  // namespace motion
