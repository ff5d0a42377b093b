// SPDX-License-Identifier: MIT
#pragma once

#include <limits>
#include <vector>

#include "frame.hpp"
#include "motion_kernels.hpp"
#include "oracle.hpp"
#include "view.hpp"

namespace cellist::test {

/// The lists that the method `exact` keeps, with all that they are made from, for tests to look at.
class RangeMap {
public:
    RangeMap(const Device& device, const motion::Scene& scene, int side)
        : buffers_(device, scene),
          seen_(device, scene, motion::light_view(scene.light, side)),
          farthest_(device, static_cast<std::size_t>(side) * static_cast<std::size_t>(side)),
          ranges_(device, {farthest_.size()}, {}),
          pieces_(device, {farthest_.size()}, {}),
          project_(motion::moving_kernel(device, motion::kernels::project_cl, "project_vertices")),
          sweep_(device, motion::kernels::sweep_exact_cl, ranges_),
          compress_(motion::moving_kernel(device, motion::kernels::compress_cl, "compress_ranges",
                                          pieces_, ranges_)) {
        farthest_.fill(std::numeric_limits<cl_float>::infinity());
        project_.run(Range::padded(buffers_.vertex_count, 64), seen_.view, buffers_.begin,
                     buffers_.end, buffers_.vertex_count, seen_.vertices);
        report_ = ranges_.build([&] { sweep_.run(buffers_, seen_, ranges_, farthest_); });
        ranges_.sort(&motion::VisibleRange::begin);
    }

    /// Merges ranges. The tolerance is in texels.
    HostLists<motion::DepthPiece> pieces(float tolerance) {
        const auto texels = static_cast<cl_uint>(farthest_.size());
        pieces_.build([&] {
            compress_.run(Range::padded(texels, 64), pieces_, ranges_, seen_.view, seen_.vertices,
                          buffers_.indices, cl_uint{0}, texels, tolerance);
        });
        return pieces_.download();
    }

    [[nodiscard]] const motion::View& view() const { return seen_.view; }
    [[nodiscard]] const BuildReport& report() const { return report_; }
    [[nodiscard]] HostLists<motion::VisibleRange> ranges() const { return ranges_.download(); }
    [[nodiscard]] std::vector<motion::MovingVertex> vertices() const {
        return seen_.vertices.download();
    }

private:
    motion::SceneBuffers buffers_;
    motion::SeenScene seen_;
    Buffer<cl_float> farthest_;
    Lists<motion::VisibleRange> ranges_;
    Lists<motion::DepthPiece> pieces_;
    Kernel project_;
    motion::Sweep sweep_;
    Kernel compress_;
    BuildReport report_;
};

}  // namespace cellist::test
