// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

#include <nlohmann/json.hpp>

#include "budget/measurement.hpp"
#include "frame_options.hpp"
#include "reference/comparison.hpp"

namespace oit {

// The parts of the JSON reports that all programs share. docs/json.md has the table of keys.

/// The version of that table.
inline constexpr int json_schema = 1;

/// The shortest number that stands for a float: 0.35, without the extra digits of a double.
[[nodiscard]] double as_read(float value);

/// The program, how it was called, and what it draws: the head of a report.
[[nodiscard]] nlohmann::ordered_json json_of(const FrameOptions& options, std::string_view program);

/// A setting: the method, and the accuracy that it gives up for speed.
[[nodiscard]] nlohmann::ordered_json json_of(const Setting& setting);

/// The times of frames.
[[nodiscard]] nlohmann::ordered_json times_json(const Measurement& measurement);

/// How far a picture is from the reference.
[[nodiscard]] nlohmann::ordered_json json_of(const Comparison& comparison);

}  // namespace oit
