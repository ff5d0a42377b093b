// Inserting 16-byte nodes (12 bytes and the link), by distribution and allocation, beside its
// ceilings in the same run: the same stores alone, and stores with the exchange of the head but
// without an allocation.

#include <cstdlib>
#include <iostream>
#include <string>

#include <benchmark/benchmark.h>

#include <cellist/cellist.hpp>

#include "bench_kernels.hpp"

struct Record {
    cl_uint a, b, c;
};
CELLIST_STRUCT(Record, a, b, c);

namespace {

double seconds(const cl::Event& event) {
    event.wait();
    const auto begin = event.getProfilingInfo<CL_PROFILING_COMMAND_START>();
    const auto end = event.getProfilingInfo<CL_PROFILING_COMMAND_END>();
    return 1e-9 * static_cast<double>(end - begin);
}

struct Case {
    const char* kernel;
    cellist::Allocation allocation;
};

void run(benchmark::State& state, const cellist::Device& device, const Case& what, cl_uint pattern,
         cl_uint nodes, cl_uint cells) {
    cellist::Lists<Record> lists(device, {cells},
                                 {.capacity_nodes = nodes, .allocation = what.allocation});
    cellist::Kernel kernel(device, bench::kernels::insert_cl, what.kernel, lists);

    // Every case is checked once before it is timed; this is the warm-up as well.
    const cellist::BuildReport report = lists.build(kernel, nodes, pattern);
    if (std::string(what.kernel) == "insert" && (report.stored != nodes || !lists.validate().ok()))
        state.SkipWithError("the lists are wrong");

    for (auto _ : state) {
        cl::Event event;
        lists.build([&] { event = kernel.run(nodes, lists, pattern); });
        state.SetIterationTime(seconds(event));
    }
    const auto items = static_cast<std::int64_t>(state.iterations()) * nodes;
    state.SetItemsProcessed(items);
    state.SetBytesProcessed(items * 16);
}

}  // namespace

int main(int argc, char** argv) try {
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;

    const cellist::Device device = cellist::Device::choose();
    const bool gpu = (device.info().type & CL_DEVICE_TYPE_GPU) != 0;
    const cl_uint nodes = gpu ? 1u << 26 : 1u << 22;
    const cl_uint cells = gpu ? 1u << 22 : 1u << 18;
    benchmark::AddCustomContext("device", device.info().name);
    benchmark::AddCustomContext("driver", device.info().driver);
    benchmark::AddCustomContext("git", CELLIST_GIT_HASH);
    benchmark::AddCustomContext("nodes", std::to_string(nodes));
    benchmark::AddCustomContext("cells", std::to_string(cells));

    const char* patterns[] = {"random", "coherent", "runs", "hot"};
    const std::pair<const char*, Case> cases[] = {
        {"store", {"store", cellist::Allocation::sharded}},
        {"exchange_and_store", {"exchange_and_store", cellist::Allocation::sharded}},
        {"insert/sharded", {"insert", cellist::Allocation::sharded}},
        {"insert/global", {"insert", cellist::Allocation::global}},
    };
    for (cl_uint pattern = 0; pattern < std::size(patterns); ++pattern)
        for (const auto& [name, what] : cases)
            benchmark::RegisterBenchmark(
                (std::string(name) + "/" + patterns[pattern]).c_str(),
                [&device, what = what, pattern, nodes, cells](benchmark::State& state) {
                    run(state, device, what, pattern, nodes, cells);
                })
                ->UseManualTime()
                ->Unit(benchmark::kMillisecond)
                ->Iterations(7)
                ->Repetitions(1);
    benchmark::RunSpecifiedBenchmarks();
    benchmark::Shutdown();
    return 0;
} catch (const std::exception& error) {
    std::cerr << "bench_insert: " << error.what() << '\n';
    return 1;
}
