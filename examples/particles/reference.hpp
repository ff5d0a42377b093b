// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include <cellist/opencl.hpp>

#include "scene.hpp"

namespace particles {

struct Comparison {
    std::string method;  ///< how the neighbours were found again
    std::size_t points = 0;
    std::size_t different = 0;
};

/// Finds the neighbours of `sample` points (the first ones, then evenly spread) on the CPU, with
/// nanoflann's k-d tree where the program was built with it, else of at most 500 by looking at
/// every point, and compares them with what the device found. Who is a neighbour is decided in the
/// same arithmetic, so there is no tolerance.
[[nodiscard]] Comparison compare(const Scene& scene, std::span<const cl_uint2> found,
                                 std::size_t sample);

}  // namespace particles
