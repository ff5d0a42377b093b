// SPDX-License-Identifier: MIT
// A plug-in with a single function. It exports no symbol of the library that it links.
#include <cellist/cellist.hpp>

struct Point {
    cl_float x;
};
CELLIST_STRUCT(Point, x);

/// Throws cellist::Error, whatever the device.
extern "C" __attribute__((visibility("default"))) void plugin_throw() {
    const cellist::Device device = cellist::Device::choose();
    const cellist::Lists<Point> lists(device, {1}, {.overflow = cellist::Overflow::stop});
    throw std::runtime_error("no error");
}
