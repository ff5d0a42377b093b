#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "comparison.hpp"
#include "frame_options.hpp"
#include "measurement.hpp"

namespace oit {

// What the reports of all programs have in common: one name for one thing. docs/json.md has the table.

/// The version of that table.
inline constexpr int json_schema = 1;

/// Null where a value is infinite or no number.
[[nodiscard]] nlohmann::ordered_json finite_or_null(double value);

/// The number that people read for a float: 0.35, and not what is added to the digits of a double.
[[nodiscard]] double as_read(float value);

/// The program, how it was called, and what it draws: the head of a report.
[[nodiscard]] nlohmann::ordered_json json_of(const FrameOptions& options, std::string_view program);

/// A method, and what is given up for speed.
[[nodiscard]] nlohmann::ordered_json json_of(const Setting& setting);

/// The times of frames.
[[nodiscard]] nlohmann::ordered_json times_json(const Measurement& measurement);

/// How far a picture is from the reference.
[[nodiscard]] nlohmann::ordered_json json_of(const Comparison& comparison);

/// A file that was written, or null.
[[nodiscard]] nlohmann::ordered_json json_of(const std::filesystem::path& path);

/// Text of a JSON value; bytes that are no UTF-8 are replaced.
[[nodiscard]] std::string dump(const nlohmann::ordered_json& json, int indent);

}  // namespace oit
