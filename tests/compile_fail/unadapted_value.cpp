// SPDX-License-Identifier: MIT
// error: adapt it with CELLIST_STRUCT
#include <cellist/value.hpp>

struct Camera {
    cl_float zoom;
};

cellist::Values values() { return {{"camera", Camera{}}}; }
