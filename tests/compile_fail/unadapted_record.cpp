// error: adapt the record with CELLIST_STRUCT first
// SPDX-License-Identifier: MIT
#include <cellist/cellist.hpp>

struct Hit {
    cl_float depth;
    cl_uint id;
};

void use(cellist::Lists<Hit>& hits) { hits.clear(); }
