// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "budget/measurement.hpp"
#include "tradeoff/tradeoff_options.hpp"

namespace oit {

/// A method that cannot draw the frame at all.
struct LeftOut {
    std::string_view method;
    std::string reason;
};

/// All settings of a frame, measured on a device.
struct Sweep {
    TradeoffOptions options;
    std::string device;
    std::string driver;
    /// Pictures that the reference is the mean of; 0 where it is drawn in double precision.
    std::uint64_t reference_views = 0;
    std::uint64_t triangles = 0;
    std::uint64_t fragments = 0;
    std::uint64_t most_layers = 0;  ///< in any pixel
    /// Pixels by layers: none, 1, 2 to 3, 4 to 7 and so on.
    std::vector<std::uint64_t> pixels_by_layers = {};
    std::uint32_t frames = 0;                    ///< of each setting that are timed
    std::vector<Measurement> measurements = {};  ///< by time; failures last
    std::vector<LeftOut> left_out = {};

    /// The name of the scene, or of its file.
    [[nodiscard]] std::string scene_name() const;
};

/// The settings of the named methods, in the order in which they are to be measured.
[[nodiscard]] std::vector<Setting> settings_of(const Frame& frame, std::uint64_t most_layers,
                                               std::span<const std::string_view> methods);

/// 1, 2, 4 and 8 samples and exact coverage, with the method `linked`.
[[nodiscard]] std::vector<Setting> settings_of_samples(const Frame& frame);

/// Those of the named methods that refuse the frame.
[[nodiscard]] std::vector<LeftOut> left_out(const Frame& frame,
                                            std::span<const std::string_view> methods);

/// From here on, in dB of PSNR, settings count as equally accurate: the error is less than a step
/// of 16 bits, and what is left is rounding.
inline constexpr double psnr_enough = 96;

/// Measures the settings interleaved: a part of the frames of each, and then the next part, so that
/// what slows the machine for a while does not fall to a few of them. `measured` gets what the
/// first round has found of a setting, and the image; `progress` the finished part of the other
/// rounds. Blocks.
[[nodiscard]] std::vector<Measurement> measure_interleaved(
    const cellist::Device& device, const Frame& frame, const Reference& reference,
    std::span<const Setting> settings, std::uint32_t frames,
    const std::function<void(Measurement&)>& measured, const std::function<void(double)>& progress);

/// How far half of the times are from their median at most, as a part of it: in the setting that is
/// in the middle.
[[nodiscard]] double typical_spread(std::span<const Measurement> measurements);

/// Pixels by layers, as Sweep has them.
[[nodiscard]] std::vector<std::uint64_t> pixels_by_layers(const cellist::Lengths& layers);

/// Which measurements no other one beats: none is as fast and as accurate, and better in one of
/// these. What is slower is slower by measurably_slower().
[[nodiscard]] std::vector<bool> pareto_front(std::span<const Measurement> measurements);

/// A measurement, and how many times as long another one takes: by the medians, and at least and at
/// most by the quartiles.
struct Relation {
    const Measurement* measurement;
    double factor;
    double least, most;
    bool is_distinct;  ///< whether the times tell which of the two is slower
};

/// The K nearest layers in lists against all of them, K ascending: the factor is the speed-up.
[[nodiscard]] std::vector<Relation> fewer_layers(const Sweep& sweep);

/// Exact methods with nodes of floats against `linked`, fastest first: the factor is how many times
/// as long they take (Yang et al. 2010, Table 1). Nothing where `linked` was not measured, or where
/// samples are compared.
[[nodiscard]] std::vector<Relation> exact_methods(const Sweep& sweep);

}  // namespace oit
