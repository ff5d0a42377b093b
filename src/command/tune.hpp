#pragma once

#include <iosfwd>

#include <cellist/device.hpp>

namespace cellist::command {

/// Measures what a record costs on a device in each storage, prints a table, and writes the file that
/// Storage::automatic starts from. Returns the exit status. Throws Error, where the file cannot be
/// written too. Takes seconds.
int tune(const Device& device, std::ostream& out);

}  // namespace cellist::command
