// SPDX-License-Identifier: MIT
// error: OpenCL C has no bool of a fixed size
#include <cellist/value.hpp>

cellist::Values values() { return {{"flag", true}}; }
