// error: type has no counterpart in OpenCL C
// SPDX-License-Identifier: MIT
#include <cellist/cellist.hpp>

struct Hit {
    cl_float depth;
    const cl_uint* id;
};
CELLIST_STRUCT(Hit, depth, id);
