// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

namespace support {

/// The head of a report: the version of its table of keys, the program, and how it was called.
[[nodiscard]] nlohmann::ordered_json report_head(int schema, std::string_view program,
                                                 std::span<const std::string> arguments);

/// Null for a value that is infinite or NaN.
[[nodiscard]] nlohmann::ordered_json finite_or_null(double value);

/// A file that was written, or null.
[[nodiscard]] nlohmann::ordered_json file_or_null(const std::filesystem::path& path);

/// The text of a JSON value; replaces bytes that are not UTF-8.
[[nodiscard]] std::string dump(const nlohmann::ordered_json& json, int indent);

/// A CSV file (RFC 4180) with a line for each of some objects. Its columns are members of these
/// names; what is null or missing is empty.
[[nodiscard]] std::string csv(std::span<const char* const> names,
                              const nlohmann::ordered_json& objects);

}  // namespace support
