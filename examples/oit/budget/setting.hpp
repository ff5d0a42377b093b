// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "frame/frame.hpp"
#include "methods/method.hpp"

namespace oit {

/// A method, and what is given up for speed: one point of the trade between them.
struct Setting {
    const MethodInfo* method;
    Quality quality;
};

/// "linked", or "adaptive:8" where the size is not left to the method.
[[nodiscard]] std::string method_text(const Setting& setting);

/// The options of cellist-oit that give a setting: "--method linked --layers 8".
[[nodiscard]] std::string text(const Setting& setting);

/// True where `a` is the plainer of two: where times do not tell which is faster, it is chosen.
/// First come exact methods, then what keeps all layers and does not end early, then floats, then
/// the method that comes first in the table, and then more layers, a later end and the greater
/// size.
[[nodiscard]] bool plainer(const Setting& a, const Setting& b);

/// All layers in nodes of floats with the method `linked`: what other settings are a trade of.
/// Samples, resolve, ranges and scale of depth are those of `quality`.
[[nodiscard]] Setting exact_setting(const Quality& quality);

/// The settings worth comparing for a frame, those that a method refuses left out. Samples,
/// resolve, ranges and scale of depth are those of the frame. Exact methods come in each node
/// format; those that cut also with 1, 2, 4 ... 64 nearest layers, as long as that is fewer than
/// `most_layers`, the most in any pixel, and with early ends, or with a lens in numbers of rays;
/// approximations in each of their sizes.
[[nodiscard]] std::vector<Setting> settings_for(const Frame& frame, std::uint64_t most_layers);

/// The frame that a setting draws instead of this one.
[[nodiscard]] Frame with_setting(const Frame& frame, const Setting& setting);

}  // namespace oit
