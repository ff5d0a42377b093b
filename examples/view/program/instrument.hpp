// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <cellist/cellist.hpp>

#include "camera.hpp"
#include "program/arguments.hpp"

namespace viewer {

/// A fragment in the list of a pixel.
struct ListEntry {
    double depth = 0;
    double colour[3] = {};  ///< linear, not multiplied by alpha
    double alpha = 0;
    unsigned coverage = 0;  ///< a bit for each sample
    std::string blend = {};
};

/// A number for each pixel, row by row from the top.
struct PixelCounts {
    std::vector<cl_uint> counts;
    std::string caption;  ///< letters and spaces
};

/// A line of the panel about the last picture.
using Fact = std::pair<std::string, std::string>;

/// What the window shows of a drawn picture beside the picture itself.
struct PictureInfo {
    double frame_ms = 0;
    bool moves = false;         ///< time changes the scene
    support::Orbit orbit = {};  ///< where the camera is
    std::vector<Fact> facts = {};
};

/// Draws the pictures of one program, with the program's own code. All functions but draw() are
/// about the last picture that was drawn. All block.
class Instrument {
public:
    Instrument() = default;
    Instrument(const Instrument&) = delete;
    Instrument& operator=(const Instrument&) = delete;
    virtual ~Instrument() = default;

    /// Draws what the arguments ask for. Throws InputError where they cannot be used,
    /// cellist::Error where the device cannot draw; and what `progress` throws.
    virtual PictureInfo draw(const Arguments& arguments) = 0;

    /// Width and height of an eye's image in pixels.
    [[nodiscard]] virtual std::pair<int, int> size() const = 0;
    [[nodiscard]] virtual std::size_t eyes() const { return 1; }
    /// The linear image, eye by eye, row by row from the top.
    [[nodiscard]] virtual const cellist::Buffer<cl_float4>& image() const = 0;
    /// Lengths of the lists that the picture is made of, eye by eye; or nothing.
    [[nodiscard]] virtual std::optional<PixelCounts> list_lengths() { return {}; }
    /// The list of a pixel of an eye, nearest first; nothing where pixels have no lists.
    [[nodiscard]] virtual std::optional<std::vector<ListEntry>> list_at(int x, int y,
                                                                        std::size_t eye) {
        (void)x, (void)y, (void)eye;
        return {};
    }
};

/// What instruments share.
struct Studio {
    const cellist::Device& device;
    /// Called with the progress of long work, from 0 to 1. Throws to end it.
    std::function<void(double)> progress = [](double) {};
};

}  // namespace viewer
