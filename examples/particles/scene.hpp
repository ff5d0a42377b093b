// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <cellist/opencl.hpp>

namespace particles {

/// How space ends.
enum class Box {
    open,      ///< nowhere
    periodic,  ///< what leaves the unit box on one side comes in on the other
};

/// Points and the distance up to which two of them are neighbours.
struct Scene {
    Box box = Box::periodic;
    float radius = 0;
    std::vector<cl_float4> points;  ///< x, y, z; the fourth component is not used
    std::size_t invalid = 0;        ///< points with a coordinate that is NaN or infinite
};

/// Points that fill the unit box evenly, with about `neighbours` neighbours each. From 16 points
/// on, one lies far outside of the box, and three have coordinates that are no numbers.
[[nodiscard]] Scene make_scene(std::size_t points, double neighbours, Box box, std::uint32_t seed);

[[nodiscard]] bool is_finite(const cl_float4& point);

}  // namespace particles
