// SPDX-License-Identifier: MIT
// Compiles. Each other file has one mistake, which the compiler must explain as its first line
// says.
#include <cellist/cellist.hpp>

struct Hit {
    cl_float depth;
    cl_uint id;
};
CELLIST_STRUCT(Hit, depth, id);

void use(cellist::Lists<Hit>& hits, cellist::Kernel& kernel) {
    hits.build(kernel, 1, cl_uint{1});
    hits.sort(&Hit::depth);
}
