// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "drawing/request.hpp"

namespace viewer {

/// Draws one side of the window.
class SideDrawer {
public:
    /// Refers to the studio.
    explicit SideDrawer(const Studio& studio);

    /// Draws the side of a request. Errors of the program, the device or the host's memory are in
    /// the result; what Studio::progress throws passes through. Blocks.
    [[nodiscard]] DrawnSide draw(const Request& request, std::size_t side);

    /// What was drawn last, as linear pixels of all eyes side by side. Blocks.
    [[nodiscard]] std::vector<cl_float4> linear_image() const;
    /// The list lengths of what was drawn last, in the same order.
    [[nodiscard]] std::optional<PixelCounts> list_lengths() const;
    /// Width, of all eyes side by side, and height of what was drawn last; 0 where nothing was.
    [[nodiscard]] std::pair<int, int> size() const;

private:
    void show_picture(DrawnSide& drawn);
    void show_heat_map(DrawnSide& drawn);

    const Studio& studio_;
    cellist::Kernel to_bytes_;
    cellist::Buffer<cl_uchar> encoded_;  ///< see screen_bytes.cl
    const Program* program_ = nullptr;
    std::unique_ptr<Instrument> instrument_;
    bool has_picture_ = false;
    std::optional<cellist::Buffer<cl_uint>> bytes_;
};

}  // namespace viewer
