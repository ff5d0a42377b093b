#pragma once

#include <filesystem>
#include <iosfwd>
#include <string>

#include <nlohmann/json.hpp>

#include "sweep.hpp"

namespace oit {

/// One screen for people.
void print(const Sweep& sweep, std::ostream& out);

/// All figures. What is infinite or was not measured is null.
[[nodiscard]] nlohmann::ordered_json to_json(const Sweep& sweep);

/// A line for each setting, behind a line of names.
[[nodiscard]] std::string to_csv(const Sweep& sweep);

/// Text of a JSON value; bytes that are no UTF-8 are replaced.
[[nodiscard]] std::string dump(const nlohmann::ordered_json& json, int indent);

/// Throws InputError where the file cannot be written.
void write_file(const std::filesystem::path& path, const std::string& text);

}  // namespace oit
