// SPDX-License-Identifier: MIT
// error: OpenCL C has no bool parameters: pass a cl_uint
#include <cellist/cellist.hpp>

void use(cellist::Kernel& kernel) { kernel.run(1, true); }
