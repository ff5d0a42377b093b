// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include <cellist/cellist.hpp>

#include "frame/fragment_source.hpp"

namespace oit {

/// The source of a method that gathers the picture through a lens, after lens_common.clh and the
/// defines.
[[nodiscard]] std::string lens_text(const std::string& defines, std::string_view source);

/// The lens of a frame, and the range of depths that each tile can see: see lens_common.clh.
class LensRanges {
public:
    explicit LensRanges(const FragmentSource& source);

    /// Empties all ranges. Does not block.
    void clear() { ranges_.fill(no_range); }
    /// Spreads each range to the tiles that can see its surfaces. Does not block.
    void spread();
    [[nodiscard]] const cellist::Buffer<cl_uint2>& ranges() const { return ranges_; }

    /// Pixels by which the view from the edge of the lens moves per unit of 1 / depth.
    [[nodiscard]] cl_float scale() const { return scale_; }
    /// 1 / depth in focus.
    [[nodiscard]] cl_float focus() const { return focus_; }
    [[nodiscard]] std::uint64_t device_bytes() const { return raster::bytes_of(ranges_, along_x_); }

private:
    static constexpr cl_uint2 no_range{{0xFFFFFFFF, 0}};

    cl_float scale_;
    cl_float focus_;
    cellist::Kernel spread_;
    cellist::Range tiles_;
    cellist::Buffer<cl_uint2> ranges_;
    cellist::Buffer<cl_uint2> along_x_;  ///< spread along x only
};

}  // namespace oit
