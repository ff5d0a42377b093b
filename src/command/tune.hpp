// SPDX-License-Identifier: MIT
#pragma once

#include <iosfwd>

#include <cellist/device.hpp>

namespace cellist::command {

/// Measures the cost of a record on a device in each storage and prints a table. Writes the profile
/// that Storage::automatic starts from. Returns the exit status. Throws Error, also if it cannot
/// write the profile. Takes seconds.
int tune(const Device& device, std::ostream& out);

}  // namespace cellist::command
