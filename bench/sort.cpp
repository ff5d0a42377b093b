// Sorting lists of 12-byte records by a float, by storage and lengths of the lists, beside its
// ceiling in the same run: one walk that reads every record of the unsorted lists.

#include <algorithm>
#include <ctime>
#include <cstdlib>
#include <iostream>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include <cellist/cellist.hpp>

#include "bench_kernels.hpp"

struct Record {
    cl_float key;
    cl_uint a, b;
};
CELLIST_STRUCT(Record, key, a, b);

namespace {

constexpr std::pair<const char*, cellist::Storage> storages[] = {
    {"linked", cellist::Storage::linked},
    {"counted", cellist::Storage::counted},
};

/// What is timed.
enum class Work { walk, sort, partial };

struct Case {
    Work work;
    cellist::Storage storage;
    cl_uint length;  ///< of each list; 0: random, 16 on average
};

/// Device time between the ends of two commands.
double seconds(const cl::Event& first, const cl::Event& last) {
    last.wait();
    const auto begin = first.getProfilingInfo<CL_PROFILING_COMMAND_END>();
    const auto end = last.getProfilingInfo<CL_PROFILING_COMMAND_END>();
    return 1e-9 * static_cast<double>(end - begin);
}

bool sorted(const cellist::HostLists<Record>& lists) {
    for (std::uint64_t cell = 0; cell < lists.cells(); ++cell) {
        const auto list = lists.cell(cell);
        for (std::size_t i = 1; i < list.size(); ++i)
            if (list[i].key < list[i - 1].key ||
                (list[i].key == list[i - 1].key && list[i].a < list[i - 1].a))
                return false;
    }
    return true;
}

void run(benchmark::State& state, const cellist::Device& device, const Case& what, cl_uint bits) {
    const cl_uint nodes = 1u << bits;
    const cl_uint cells = nodes / (what.length == 0 ? 16 : what.length);
    cellist::Lists<Record> lists(device, {cells},
                                 {.storage = what.storage, .capacity_nodes = nodes});
    cellist::Kernel fill(device, bench::kernels::sort_cl, "fill", lists);
    cellist::Kernel walk(device, bench::kernels::sort_cl, "walk", lists);
    const cellist::Buffer<cl_float> sums(device, cells);

    // Every case is checked once before it is timed; this is the warm-up as well.
    lists.build(fill, nodes, bits, what.length);
    lists.sort(&Record::key);
    if (!lists.validate().ok() || (nodes <= 1u << 24 && !sorted(lists.download())))
        state.SkipWithError("the lists are wrong");
    walk.run(cellist::Range::padded(cells), lists, sums);

    std::vector<double> times;
    std::vector<double> busy;
    for (auto _ : state) {
        for (int i = 0; i < 7; ++i) {
            lists.build(fill, nodes, bits, what.length);
            cl::Event before;
            device.queue().enqueueMarkerWithWaitList(nullptr, &before);
            device.finish();
            const std::clock_t start = std::clock();
            const cl::Event after = what.work == Work::walk
                                        ? walk.run(cellist::Range::padded(cells), lists, sums)
                                        : lists.sort(&Record::key);
            times.push_back(seconds(before, after));
            busy.push_back(static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
        }
        std::sort(times.begin(), times.end());
        state.SetIterationTime(times[times.size() / 2]);
    }
    state.SetItemsProcessed(nodes);
    state.counters["min_ms"] = 1e3 * times.front();
    state.counters["max_ms"] = 1e3 * times.back();
    state.counters["cpu_ms"] = 1e3 * *std::min_element(busy.begin(), busy.end());
}

}  // namespace

int main(int argc, char** argv) try {
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;

    const cellist::Device device = cellist::Device::choose();
    const bool gpu = (device.info().type & CL_DEVICE_TYPE_GPU) != 0;
    const char* named = std::getenv("CELLIST_BENCH_BITS");
    const auto bits = static_cast<cl_uint>(named != nullptr ? std::stoul(named) : gpu ? 26 : 22);
    benchmark::AddCustomContext("device", device.info().name);
    benchmark::AddCustomContext("driver", device.info().driver);
    benchmark::AddCustomContext("git", CELLIST_GIT_HASH);
    benchmark::AddCustomContext("nodes", std::to_string(1u << bits));

    for (const cl_uint length : {0u, 8u, 16u, 32u, 64u, 1024u, 1u << 22})
        for (const auto& [name, storage] : storages)
            for (const Work work : {Work::walk, Work::sort}) {
                const std::string lists =
                    length == 0 ? std::string("random 16") : std::to_string(length) + " each";
                benchmark::RegisterBenchmark(
                    ((work == Work::walk ? "walk/" : "sort/") + std::string(name) + "/" + lists)
                        .c_str(),
                    [&device, bits, what = Case{work, storage, length}](benchmark::State& state) {
                        run(state, device, what, bits);
                    })
                    ->UseManualTime()
                    ->Unit(benchmark::kMillisecond)
                    ->Iterations(1);
            }
    benchmark::RunSpecifiedBenchmarks();
    benchmark::Shutdown();
    return 0;
} catch (const std::exception& error) {
    std::cerr << "bench_sort: " << error.what() << '\n';
    return 1;
}
