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

kernel void split(CELLIST_LISTS(Sample, even), CELLIST_LISTS(Sample, odd))
{
    uint i = get_global_id(0);
    Sample s = { i, i };
    if (i % 2)
        cellist_insert(odd, i / 100, s);
    else
        cellist_insert(even, i / 100, s);
}

kernel void sums(global const uint* offsets, global const Sample* records, global float* sums)
{
    uint cell = get_global_id(0);
    sums[cell] = 0;
    for (uint i = offsets[cell]; i < offsets[cell + 1]; ++i) sums[cell] += records[i].key;
}
)";

int main() {
    cellist::Device device = cellist::Device::choose();

    // The same kernel fills any storage.
    std::vector<std::vector<cl_uint>> results;
    for (auto storage : cellist::all_storages) {
        cellist::Lists<Sample> samples(device, {1000}, {.storage = storage});
        cellist::Kernel sample(device, source, "sample", samples);
        samples.build(sample, 100'000);
        samples.sort(&Sample::key);
        std::vector<cl_uint> ids;
        for (const Sample& s : samples.download().records()) ids.push_back(s.id);
        results.push_back(ids);
    }
    check(results[0].size() == 100'000, "all samples are stored");
    for (const auto& result : results) check(result == results[0], "sorted lists are the same");

    cellist::Lists<Sample> samples(device, {1000}, {.storage = cellist::Storage::linked});
    cellist::Kernel sample(device, source, "sample", samples);
    samples.build(sample, 100'000);

    cellist::Lists<Sample> chosen(device, {1000},
                                  {.storage = cellist::Storage::automatic, .expected_reads = 3});
    for (int frame = 0; frame < 14; ++frame) chosen.build(sample, 100'000);
    std::cout << chosen.storage_reason() << '\n';
    check(chosen.download().records().size() == 100'000, "all samples are stored");

    cellist::Packed<Sample> packed = samples.pack();
    cellist::Kernel sums(device, source, "sums", cellist::type<Sample>);
    cellist::Buffer<cl_float> result(device, samples.shape().cells());
    sums.run(samples.shape().cells(), packed.offsets, packed.records, result);
    check(result.download().size() == 1000, "a sum for each cell");
    check(packed.records.size() == 100'000, "all records are packed");

    cellist::Lists<Sample> even(device, {100}), odd(device, {100});
    cellist::Kernel split(device, source, "split", even);
    auto reports = cellist::build([&] { split.run(10'000, even, odd); }, even, odd);
    check(reports[0].stored == 5000 && reports[1].stored == 5000, "both containers are filled");
    std::cout << "storages: ok\n";
}
