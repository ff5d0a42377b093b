// SPDX-License-Identifier: MIT
// error: type has no counterpart in OpenCL C
#include <cellist/cellist.hpp>

struct Hit {
    cl_float depth;
    const cl_uint* id;
};
CELLIST_STRUCT(Hit, depth, id);
