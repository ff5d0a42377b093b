// error: decomposes into 3 elements
// SPDX-License-Identifier: MIT
#include <cellist/struct.hpp>

struct Colour {
    explicit Colour(cl_uint value) : rgba(value) {}
    cl_uint rgba;
};
struct Photon {
    cl_ulong key;
    cl_uint id;
    Colour colour;
};
CELLIST_STRUCT(Photon, key, id);

int main() {}
