// SPDX-License-Identifier: MIT
#include <cellist/cellist.hpp>

#include "check.hpp"

struct Star {
    cl_float x, y, z;
    cl_uint id;
};
CELLIST_STRUCT(Star, x, y, z, id);

constexpr auto source = R"(
#include <cellist/lists.clh>

kernel void place(CELLIST_LISTS(Star, stars), global const Star* all, float cell_size)
{
    Star s = all[get_global_id(0)];
    uint cell = cellist_hash_cell3(stars, s.x / cell_size, s.y / cell_size, s.z / cell_size);
    cellist_insert(stars, cell, s);
}

// The number of stars that are nearer to each star than cell_size.
kernel void count(CELLIST_LISTS(Star, stars), global const Star* all, float cell_size,
                  global uint* counts)
{
    Star s = all[get_global_id(0)];
    int x = floor(s.x / cell_size), y = floor(s.y / cell_size), z = floor(s.z / cell_size);
    uint found = 0;
    for (int k = z - 1; k <= z + 1; ++k)
        for (int j = y - 1; j <= y + 1; ++j)
            for (int i = x - 1; i <= x + 1; ++i)
                cellist_for_each(stars, cellist_hash_cell3(stars, i, j, k), node) {
                    Star other = cellist_get(stars, node);
                    // Also tells apart stars of other positions with the same cell.
                    found += other.id != s.id && distance((float3)(s.x, s.y, s.z),
                                                          (float3)(other.x, other.y, other.z))
                                                     < cell_size;
                }
    counts[get_global_id(0)] = found;
}

// Whether a cell of the domain has a star.
kernel void has_star(CELLIST_LISTS(Star, stars), int3 at, float cell_size, global uint* has_star)
{
    *has_star = 0;
    cellist_for_each(stars, cellist_hash_cell3(stars, at.x, at.y, at.z), node) {
        Star s = cellist_get(stars, node);
        int3 own = convert_int3_rtn((float3)(s.x, s.y, s.z) / cell_size);
        if (all(own == at)) *has_star = 1;
    }
}
)";

int main() {
    cellist::Device device = cellist::Device::choose();
    std::vector<Star> all;
    for (cl_uint i = 0; i < 1000; ++i)
        all.push_back({float(i % 10), float(i / 10 % 10) - 5.0f, -float(i / 100), i});
    all.push_back({1e9f, -1e9f, 1e9f, 1000});  // an outlier
    cellist::Buffer<Star> uploaded(device, all);

    // Any number of cells will do: about one for each cell of the domain that has records.
    cellist::Lists<Star> stars(device, {1024});
    cellist::Kernel place(device, source, "place", stars);
    stars.build(place, all.size(), uploaded, 1.5f);

    cellist::Buffer<cl_uint> counts(device, all.size());
    cellist::Kernel count(device, source, "count", stars);
    count.run(all.size(), stars, uploaded, 1.5f, counts);
    std::vector<cl_uint> found = counts.download();
    check(found[555] == 18, "neighbours on a side and an edge");
    check(found[1000] == 0, "the outlier is alone");

    cellist::Buffer<cl_uint> answer(device, 1);
    cellist::Kernel has_star(device, source, "has_star", stars);
    has_star.run(1, stars, cl_int3{{0, -4, 0}}, 1.5f, answer);
    check(answer.download()[0] == 1, "a star at (0, -5, 0)");
    has_star.run(1, stars, cl_int3{{0, -40, 0}}, 1.5f, answer);
    check(answer.download()[0] == 0, "no star below");
    std::cout << "unbounded: ok\n";
}
