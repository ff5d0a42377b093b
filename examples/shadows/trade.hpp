// SPDX-License-Identifier: MIT
#pragma once

#include <iosfwd>

#include <cellist/cellist.hpp>

#include "options.hpp"

namespace shadows {

/// Changes one setting at a time, and prints the error against B at full resolution beside the
/// time of a frame. Writes options.json if it is not empty. Returns true.
bool run_trade(const cellist::Device& device, const Options& options, const Scene& scene,
               std::ostream& out);

}  // namespace shadows
