#pragma once

#include <array>
#include <cstdint>
#include <functional>

#include "mesh.hpp"
#include "raster/rasteriser.hpp"

namespace oit {

/// What a triangle covers of a pixel: as RasterFragment, in double precision.
struct ReferenceCover {
    int x, y;
    std::uint32_t coverage;
    double depth;
    std::array<double, 8> sample_depth;  ///< of the covered samples
    std::array<double, 3> weight;
    bool front;
};

/// Calls emit(triangle, cover) for every pixel that a triangle of a placed mesh covers in a view.
/// Geometry is snapped as on the device; coverage is decided in integers, all else in double.
void for_each_cover(
    const support::Mesh& mesh, const raster::RasterInstance& instance, const raster::View& view,
    int samples,
    const std::function<void(std::size_t triangle, const ReferenceCover& cover)>& emit);

}  // namespace oit
