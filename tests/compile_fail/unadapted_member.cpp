// SPDX-License-Identifier: MIT
// error: type has no counterpart in OpenCL C
#include <cellist/cellist.hpp>

struct Point {
    cl_float x, y;
};
struct Hit {
    Point point;
    cl_uint id;
};
CELLIST_STRUCT(Hit, point, id);
