// error: CELLIST_STRUCT: the layout of Hit differs from OpenCL C's
// SPDX-License-Identifier: MIT
#include <cellist/cellist.hpp>

struct Hit {
    cl_float depth;
    cl_uint id;
};
CELLIST_STRUCT(Hit, id, depth);
