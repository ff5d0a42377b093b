// error: records are ordered by a scalar member, or by an expression
// SPDX-License-Identifier: MIT
#include <cellist/cellist.hpp>

struct Hit {
    cl_float4 position;
};
CELLIST_STRUCT(Hit, position);

void use(cellist::Lists<Hit>& hits) { hits.sort(&Hit::position); }
