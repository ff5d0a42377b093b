// error: CELLIST_STRUCT: Point has more members than are named
// SPDX-License-Identifier: MIT
#include <cellist/cellist.hpp>

// What is left out stands where padding would be.
struct Point {
    cl_float position[3];
    cl_uint id;
    cl_ulong key;
};
CELLIST_STRUCT(Point, position, key);
