// SPDX-License-Identifier: MIT
#include <iostream>
#include <random>

#include <cellist/cellist.hpp>

constexpr auto source = R"(
#include <cellist/lists.clh>

kernel void splat(CELLIST_LISTS(Hit, hits), global const float4* points)
{
    uint i = get_global_id(0);
    Hit hit = { points[i].z, i };
    cellist_insert(hits, cellist_cell2(hits, points[i].x, points[i].y), hit);
}
)";

struct Hit {
    cl_float depth;
    cl_uint id;
};
CELLIST_STRUCT(Hit, depth, id);  // kernels know it by the same name, with the same layout

int main() {
    std::vector<cl_float4> scene(2'000'000);  // x and y in pixels, z is the depth
    std::minstd_rand r;
    for (auto& p : scene) p = {{float(r() % 1280), float(r() % 720), float(r() % 1000), 0}};

    cellist::Device device = cellist::Device::choose();  // the first GPU, else the first device
    cellist::Lists<Hit> hits(device, {1280, 720});       // grows to what the scene needs
    cellist::Buffer<cl_float4> points(device, scene);
    cellist::Kernel splat(device, source, "splat", hits);
    auto report = hits.build(splat, points.size(), points);

    hits.sort(&Hit::depth);  // nearest first, the same on every run
    auto lists = hits.download();
    for (Hit hit : lists[{640, 360}]) std::cout << hit.depth << " is point " << hit.id << "\n";
    std::cout << report.stored << " points stored on " << device.info().name << "\n";
    const bool good = report.stored == 2'000'000 && lists[{640, 360}].size() == 3;
    return good && std::cout.flush() ? 0 : 1;
}
