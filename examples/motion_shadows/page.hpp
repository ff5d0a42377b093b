// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "report.hpp"

namespace motion {

/// A page that needs no other file: pictures, tables and plots of a report with a reference.
[[nodiscard]] std::string to_html(const Report& report);

}  // namespace motion
