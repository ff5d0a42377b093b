// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <functional>

#include "mesh.hpp"
#include "reference/projection.hpp"

namespace oit {

/// What a triangle covers of a pixel, in double precision.
struct ReferenceCover {
    int x, y;
    std::uint32_t coverage;
    double depth;
    std::array<double, 8> sample_depth;  ///< of the covered samples
    std::array<double, 3> weight;
    bool front;
};

/// Calls emit(triangle, cover) for every pixel that a triangle of a placed mesh covers in a view.
/// Coverage is decided in integers of snapped geometry, all else is in double.
void for_each_cover(
    const support::Mesh& mesh, const Projection<float>& projection, int samples,
    const std::function<void(std::size_t triangle, const ReferenceCover& cover)>& emit);

}  // namespace oit
