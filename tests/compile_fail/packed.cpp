// error: CELLIST_STRUCT: the layout of Hit differs from OpenCL C's
// SPDX-License-Identifier: MIT
#include <cellist/cellist.hpp>

struct __attribute__((packed)) Hit {
    cl_uchar kind;
    cl_float depth;
};
CELLIST_STRUCT(Hit, kind, depth);
