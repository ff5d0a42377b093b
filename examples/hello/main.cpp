#include <cellist/cellist.hpp>

#include <algorithm>
#include <iostream>
#include <random>

constexpr auto source = R"(
#include <cellist/lists.clh>

kernel void splat(CELLIST_LISTS(Hit, hits), global const float4* points, uint count)
{
    uint i = get_global_id(0);
    if (i >= count) return;
    Hit hit = { points[i].z, i };
    cellist_insert(hits, cellist_cell2(hits, points[i].x, points[i].y), hit);
}
)";

struct Hit { cl_float depth; cl_uint id; };
CELLIST_STRUCT(Hit, depth, id);  // kernels know it by the same name, with the same layout

int main() {
    std::vector<cl_float4> scene(2'000'000);  // x and y in pixels, z is the depth
    std::minstd_rand random;
    for (cl_float4& p : scene) p = {{float(random() % 1280), float(random() % 720), float(random() % 1000)}};

    cellist::Device device = cellist::Device::choose();  // a GPU if there is one, else PoCL
    cellist::Lists<Hit> hits(device, {1280, 720});       // grows to what the scene needs
    cellist::Kernel splat(device, source, "splat", hits);

    cellist::Buffer<cl_float4> points(device, scene);
    cellist::BuildReport report = hits.build(splat, points.size(), points, cl_uint(points.size()));

    hits.sort(&Hit::depth);  // nearest first, the same on every run
    cellist::HostLists<Hit> lists = hits.download();
    for (const Hit& hit : lists[{640, 360}]) std::cout << hit.depth << " is point " << hit.id << '\n';
    std::cout << report.stored << " hits stored on " << device.info().name << '\n';
    return report.stored == scene.size() && std::ranges::is_sorted(lists[{640, 360}], {}, &Hit::depth) ? 0 : 1;
}
