#pragma once

#include <iosfwd>

#include <cellist/device.hpp>

namespace cellist::command {

/// Inserts, grows, drops, sorts, takes the nearest and validates on a device, and compares the
/// results with the CPU's. Prints a line a check, and the first difference of a failed one. Returns
/// the exit status: 1 if a check failed. Takes seconds.
int selftest(const Device& device, std::ostream& out);

}  // namespace cellist::command
