// error: type has no counterpart in OpenCL C
// SPDX-License-Identifier: MIT
#include <cellist/cellist.hpp>

struct Hit {
    cl_float depth;
    bool opaque;
};
CELLIST_STRUCT(Hit, depth, opaque);
