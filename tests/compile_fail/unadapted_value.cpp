// error: adapt it with CELLIST_STRUCT
// SPDX-License-Identifier: MIT
#include <cellist/value.hpp>

struct Camera {
    cl_float zoom;
};

cellist::Values values() { return {{"camera", Camera{}}}; }
