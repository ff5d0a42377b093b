// SPDX-License-Identifier: MIT
#include "drawing/side_drawer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <new>
#include <tuple>
#include <utility>

#include "drawing/interrupted.hpp"
#include "heat_map.hpp"
#include "image.hpp"
#include "viewer_kernels.hpp"

namespace viewer {
namespace {

constexpr int screen_steps = 4096;

std::vector<cl_uchar> encoded_steps() {
    std::vector<cl_uchar> bytes;
    for (int step = 0; step < screen_steps; ++step) {
        const double root = static_cast<double>(step) / (screen_steps - 1);
        bytes.push_back(
            static_cast<cl_uchar>(std::lround(255 * support::srgb_from_linear(root * root))));
    }
    return bytes;
}

}  // namespace

SideDrawer::SideDrawer(const Studio& studio)
    : studio_(studio),
      to_bytes_(studio.device,
                cellist::Source{.text = "#define SCREEN_STEPS " + std::to_string(screen_steps) +
                                        "\n" + std::string(kernels::screen_bytes_cl),
                                .file_name = "screen_bytes.cl"},
                "screen_bytes"),
      encoded_(studio.device, encoded_steps()) {}

DrawnSide SideDrawer::draw(const Request& request, std::size_t side) {
    DrawnSide drawn;
    try {
        if (program_ != request.program) {
            instrument_.reset();
            has_picture_ = false;
            instrument_ = request.program->make(studio_);
            program_ = request.program;
        }
        has_picture_ = false;
        drawn.info =
            instrument_->draw(effective(request.sides.at(side), request.program->controls));
        has_picture_ = true;
        std::tie(drawn.width, drawn.height) = size();
        if (request.heat_map)
            show_heat_map(drawn);
        else
            show_picture(drawn);
        if (request.pixel) {
            const auto [width, height] = instrument_->size();
            const Pixel& pixel = *request.pixel;
            if (pixel.x < drawn.width && pixel.y < drawn.height)
                drawn.list = instrument_->list_at(pixel.x % width, pixel.y,
                                                  static_cast<std::size_t>(pixel.x / width));
        }
    } catch (const Interrupted&) {
        throw;
    } catch (const std::bad_alloc&) {
        drawn.error = "there is not enough memory";
    } catch (const std::exception& error) {
        drawn.error = error.what();
    }
    return drawn;
}

void SideDrawer::show_picture(DrawnSide& drawn) {
    const cellist::Buffer<cl_float4>& image = instrument_->image();
    const auto [width, height] = instrument_->size();
    if (!bytes_ || bytes_->size() != image.size()) bytes_.emplace(studio_.device, image.size());
    to_bytes_.run(cellist::Range::padded(image.size(), 64), image, encoded_,
                  static_cast<cl_uint>(width), static_cast<cl_uint>(height),
                  static_cast<cl_uint>(instrument_->eyes()), *bytes_);
    drawn.rgba = bytes_->download();
}

void SideDrawer::show_heat_map(DrawnSide& drawn) {
    const std::optional<PixelCounts> lengths = list_lengths();
    if (!lengths) {
        drawn.error = "this program has no lists of pixels to show as a heat map";
        return;
    }
    const cl_uint longest = std::ranges::max(lengths->counts);
    std::vector<cl_uint> colours;
    for (cl_uint length = 0; length <= longest; ++length) {
        const std::array<std::uint8_t, 3> colour =
            support::heat_colour(longest > 0 ? static_cast<double>(length) / longest : 0);
        colours.push_back(colour[0] | static_cast<cl_uint>(colour[1]) << 8 |
                          static_cast<cl_uint>(colour[2]) << 16 | 255U << 24);
    }
    for (const cl_uint length : lengths->counts) drawn.rgba.push_back(colours[length]);
    drawn.longest_list = longest;
    drawn.heat_caption = lengths->caption;
}

std::vector<cl_float4> SideDrawer::linear_image() const {
    const auto [width, height] = instrument_->size();
    return support::side_by_side(instrument_->image().download(), width, height,
                                 instrument_->eyes());
}

std::optional<PixelCounts> SideDrawer::list_lengths() const {
    std::optional<PixelCounts> lengths = instrument_->list_lengths();
    if (!lengths) return {};
    const auto [width, height] = instrument_->size();
    lengths->counts = support::side_by_side(lengths->counts, width, height, instrument_->eyes());
    return lengths;
}

std::pair<int, int> SideDrawer::size() const {
    if (!has_picture_) return {0, 0};
    const auto [width, height] = instrument_->size();
    return {width * static_cast<int>(instrument_->eyes()), height};
}

}  // namespace viewer
