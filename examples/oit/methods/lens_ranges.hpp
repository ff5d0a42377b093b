#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include <cellist/cellist.hpp>

#include "frame/fragment_source.hpp"

namespace oit {

/// The source of a method that gathers the picture through a lens, after what all of them share:
/// see lens_common.clh.
[[nodiscard]] std::string lens_text(const std::string& defines, std::string_view source);

/// The lens of a frame, and how near and far the surfaces are that each tile of it can see.
class LensRanges {
public:
    explicit LensRanges(const FragmentSource& source);

    /// Forgets what is in the tiles. Does not block.
    void clear() { ranges_.fill(no_range); }
    /// Spreads what is in the tiles to those that can see it. Does not block.
    void spread();
    [[nodiscard]] const cellist::Buffer<cl_uint2>& ranges() const { return ranges_; }

    /// Pixels by which the view from the edge of the lens moves for each 1 / depth.
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
    cellist::Buffer<cl_uint2> along_x_;  ///< spread in one direction
};

}  // namespace oit
