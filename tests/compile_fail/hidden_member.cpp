// error: decomposes into 3 elements
// SPDX-License-Identifier: MIT
#include <cellist/struct.hpp>

// With a constructor it is no aggregate; the last member lies where the device has padding.
struct Photon {
    Photon() : key(0), id(0), colour(0) {}
    cl_ulong key;
    cl_uint id;
    cl_uint colour;
};
CELLIST_STRUCT(Photon, key, id);

int main() {}
