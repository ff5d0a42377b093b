// SPDX-License-Identifier: MIT
#include <algorithm>

#include <cellist/cellist.hpp>

#include "check.hpp"

struct Hit {
    cl_float depth;
    cl_uint id;
};
CELLIST_STRUCT(Hit, depth, id);

constexpr auto source = R"(
#include <cellist/lists.clh>

kernel void scatter(CELLIST_LISTS(Hit, hits))
{
    uint i = get_global_id(0);
    Hit hit = { (float)(i * 2654435761u % 1000), i };
    cellist_insert(hits, (i * 7919) % 500, hit);
}

kernel void nearest(CELLIST_LISTS(Hit, hits), global float* depths)
{
    uint cell = get_global_id(0);
    Hit first[4];
    uint found = cellist_nearest(hits, cell, depth, 4, first);
    depths[cell] = found == 4 ? first[3].depth : INFINITY;
}
)";

int main() {
    cellist::Device device = cellist::Device::choose();
    cellist::Lists<Hit> hits(device, {500});
    cellist::Kernel scatter(device, source, "scatter", hits);

    hits.build(scatter, 100'000);
    hits.sort(&Hit::depth);
    const auto ascending = hits.download();
    hits.sort(&Hit::depth, cellist::Order::descending);
    hits.sort_by("fabs(record.depth - centre)", {{"centre", 500.0f}});
    const auto around = hits.download();
    hits.sort_async(&Hit::depth);
    check(std::ranges::equal(hits.download().records(), ascending.records(),
                             [](const Hit& a, const Hit& b) { return a.id == b.id; }),
          "two ways to sort agree");
    check(std::abs(around.cell(0).front().depth - 500) < 50, "the nearest to 500 comes first");

    hits.build(scatter, 100'000);
    hits.partial_sort(&Hit::depth, 4);  // the nearest 4 of every list, in order
    const auto front = hits.download();
    cellist::Kernel nearest(device, source, "nearest", hits);
    cellist::Buffer<cl_float> depths(device, 500);
    nearest.run(500, hits, depths);
    const auto fourth = depths.download();
    for (cl_uint cell = 0; cell < 500; ++cell) {
        check(front.cell(cell)[3].id == ascending.cell(cell)[3].id, "the first four are sorted");
        check(front.cell(cell)[3].depth == fourth[cell], "a kernel finds the same");
    }
    std::cout << "sorting: ok\n";
}
