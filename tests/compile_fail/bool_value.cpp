// error: OpenCL C has no bool of a fixed size
// SPDX-License-Identifier: MIT
#include <cellist/value.hpp>

cellist::Values values() { return {{"flag", true}}; }
