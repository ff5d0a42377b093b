// SPDX-License-Identifier: MIT
#include <cellist/cellist.hpp>

#include "check.hpp"

struct Sample {
    cl_float key;
    cl_uint id;
};
CELLIST_STRUCT(Sample, key, id);

constexpr auto source = R"(
#include <cellist/lists.clh>

kernel void sample(CELLIST_LISTS(Sample, samples))
{
    uint i = get_global_id(0);
    Sample s = { (float)(i * 2654435761u), i };
    cellist_insert(samples, (i * 7919) % 1000, s);
}

kernel void least(CELLIST_LISTS(Sample, samples), uint first_cell, global float* least)
{
    uint cell = first_cell + get_global_id(0);
    cellist_for_each(samples, cell, node) {
        least[cell] = cellist_get(samples, node).key;
        break;
    }
}
)";

int main() {
    cellist::Device device = cellist::Device::choose();
    cellist::Buffer<cl_float> least(device, 1000);

    // 12 MB of nodes pass through a pool of 1 MiB.
    cellist::Lists<Sample> samples(device, {1000}, {.budget_bytes = 1 << 20});
    cellist::Kernel sample(device, source, "sample", samples);
    cellist::Kernel take_least(device, source, "least", samples);

    int slices = 0;
    cellist::BuildReport report = samples.build_slices(
        [&] { sample.run(1'000'000, samples); },
        [&](const cellist::Slice& slice) {
            samples.sort(&Sample::key);
            take_least.run(slice.cells, samples, cl_uint(slice.first_cell), least);
            ++slices;
        });
    check(report.stored == 1'000'000 && report.dropped == 0, "every record had its turn");
    check(slices > 10, "in more than ten slices");

    // The same records in one build.
    cellist::Lists<Sample> whole(device, {1000});
    cellist::Buffer<cl_float> expected(device, 1000);
    whole.build(sample, 1'000'000);
    whole.sort(&Sample::key);
    take_least.run(1000, whole, cl_uint{0}, expected);
    check(least.download() == expected.download(), "the same results");
    std::cout << "slices: ok, " << slices << " slices\n";
}
