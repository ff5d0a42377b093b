// error: CELLIST_STRUCT: Hit must be trivially copyable and of standard layout
// SPDX-License-Identifier: MIT
#include <cellist/cellist.hpp>

struct Hit {
    cl_float depth;
    cl_uint id;
    Hit(const Hit& other) : depth(other.depth), id(other.id) {}
};
CELLIST_STRUCT(Hit, depth, id);
