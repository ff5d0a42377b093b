// error: type has no counterpart in OpenCL C
// SPDX-License-Identifier: MIT
#include <cellist/cellist.hpp>

struct Point {
    cl_float x, y;
};
struct Hit {
    Point point;
    cl_uint id;
};
CELLIST_STRUCT(Hit, point, id);
