// error: CELLIST_STRUCT: Hit must be trivially copyable and of standard layout
// SPDX-License-Identifier: MIT
#include <cellist/cellist.hpp>

struct Base {
    cl_float depth;
};
struct Hit : Base {
    cl_uint id;
};
CELLIST_STRUCT(Hit, depth, id);
