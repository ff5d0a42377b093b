// SPDX-License-Identifier: MIT
#pragma once

#include <iosfwd>

#include <cellist/device.hpp>

namespace cellist::command {

/// Checks a device: inserts, grows, drops, sorts, finds the nearest records, validates, and
/// compares the results with the CPU's. Prints one line per check, and the first difference if it
/// fails. Returns the exit status: 1 if a check failed. Takes seconds.
int selftest(const Device& device, std::ostream& out);

}  // namespace cellist::command
