// SPDX-License-Identifier: MIT
#pragma once

#include <iosfwd>
#include <string>

#include <nlohmann/json.hpp>

#include "tradeoff/sweep.hpp"

namespace oit {

/// One screen for people.
void print(const Sweep& sweep, std::ostream& out);

/// All metrics, as docs/json.md says. What is infinite or was not measured is null.
[[nodiscard]] nlohmann::ordered_json to_json(const Sweep& sweep);

/// A line for each setting, after a line of names.
[[nodiscard]] std::string to_csv(const Sweep& sweep);

}  // namespace oit
