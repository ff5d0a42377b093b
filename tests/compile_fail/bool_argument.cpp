// error: OpenCL C has no bool parameters: pass a cl_uint
// SPDX-License-Identifier: MIT
#include <cellist/cellist.hpp>

void use(cellist::Kernel& kernel) { kernel.run(1, true); }
