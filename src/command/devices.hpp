// SPDX-License-Identifier: MIT
#pragma once

#include <iosfwd>

namespace cellist::command {

/// Prints a table of all devices. Returns the exit status. Throws Error if there is no device.
int devices(std::ostream& out);

}  // namespace cellist::command
