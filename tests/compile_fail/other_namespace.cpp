// error: CELLIST_STRUCT stands in the struct's own namespace, with its plain name
// SPDX-License-Identifier: MIT
#include <cellist/cellist.hpp>

namespace scene {
struct Hit {
    cl_float depth;
    cl_uint id;
};
}  // namespace scene
CELLIST_STRUCT(scene::Hit, depth, id);
