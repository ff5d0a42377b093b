// SPDX-License-Identifier: MIT
// The benchmarks, on Google Benchmark. Times are medians of at least 7 runs. The device's clock
// times single kernels, and the host's clock times calls. The results of each case are checked
// once, before it is timed.

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>

#include <benchmark/benchmark.h>

#include <cellist/opencl.hpp>

#include "files.hpp"
#include "support/bus.hpp"
#include "support/suite.hpp"

namespace {

constexpr const char* usage =
    "usage: cellist_bench [--effort=tiny|quick|full] [--nodes=N] [--occupancy=K] [--threads=T]\n"
    "                     [--version]\n"
    "                     [options of Google Benchmark; see --help]\n"
    "  --nodes      records of the workload that ratios are taken of; 1,024 at least\n"
    "  --occupancy  records of a cell, on average; the number of cells is rounded down to a power "
    "of 2\n"
    "  --benchmark_out=FILE  the results as JSON\n"
    "  --threads    of the peers in C++; without it as many as the device has compute units\n"
    "CELLIST_DEVICE names the device.\n";

constexpr cl_uint least_nodes = 1u << 10;

struct Options {
    bench::Effort effort = bench::Effort::quick;
    cl_uint nodes = 0;
    cl_uint occupancy = 16;
    cl_uint threads = 0;
    bool version = false;
};

cl_uint number(std::string_view text) {
    cl_uint value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || value == 0)
        throw std::invalid_argument("'" + std::string(text) +
                                    "' is not a number from 1 to 2^32 - 1");
    return value;
}

cl_uint nodes(std::string_view text) {
    const cl_uint value = number(text);
    if (value < least_nodes)
        throw std::invalid_argument("--nodes is " + std::to_string(least_nodes) + " at least");
    return value;
}

bench::Effort effort(std::string_view text) {
    if (text == "tiny") return bench::Effort::tiny;
    if (text == "quick") return bench::Effort::quick;
    if (text == "full") return bench::Effort::full;
    throw std::invalid_argument("'" + std::string(text) + "' is not tiny, quick or full");
}

/// Takes the arguments that Google Benchmark does not know.
Options parse(int argc, char** argv) {
    Options options;
    for (int i = 1; i < argc; ++i) {
        const std::string_view argument = argv[i];
        const std::size_t equals = argument.find('=');
        const std::string_view name = argument.substr(0, equals);
        const std::string_view value =
            equals == std::string_view::npos ? "" : argument.substr(equals + 1);
        if (argument == "--version")
            options.version = true;
        else if (name == "--effort")
            options.effort = effort(value);
        else if (name == "--nodes")
            options.nodes = nodes(value);
        else if (name == "--occupancy")
            options.occupancy = number(value);
        else if (name == "--threads")
            options.threads = number(value);
        else
            throw std::invalid_argument("unknown argument '" + std::string(argument) + "'");
    }
    return options;
}

cl_uint default_nodes(const cellist::Device& device, bench::Effort effort) {
    const bool gpu = device.info().is_gpu();
    if (effort == bench::Effort::tiny) return least_nodes;
    const cl_uint full = gpu ? 1u << 26 : 1u << 22;
    return effort == bench::Effort::quick ? full / 4 : full;
}

/// The same device with a profiling queue.
cellist::Device profiled(const cellist::Device& device) {
    const cl::CommandQueue& queue = device.queue();
    return {device.context(), cl::CommandQueue(device.context(), queue.getInfo<CL_QUEUE_DEVICE>(),
                                               CL_QUEUE_PROFILING_ENABLE)};
}

/// Removes --benchmark_out from the arguments and returns its file. Google Benchmark would write it
/// without a check for errors.
std::string take_out_file(int& argc, char** argv) {
    constexpr std::string_view option = "--benchmark_out=";
    std::string file;
    const auto is_other = [&](const char* argument) {
        if (!std::string_view(argument).starts_with(option)) return true;
        file = argument + option.size();
        return false;
    };
    argc = static_cast<int>(std::stable_partition(argv, argv + argc, is_other) - argv);
    return file;
}

}  // namespace

int main(int argc, char** argv) try {
    support::prepare_output();
    const std::string out_file = take_out_file(argc, argv);
    if (!out_file.empty()) support::check_output_path(out_file);
    benchmark::Initialize(&argc, argv);
    Options options;
    try {
        options = parse(argc, argv);
    } catch (const std::invalid_argument& error) {
        std::cerr << "cellist_bench: " << error.what() << '\n' << usage;
        return 2;
    }

    if (options.version) {
        std::cout << "cellist_bench " CELLIST_VERSION "\n";
        support::flush_standard_output();
        return 0;
    }

    const cellist::Device device = profiled(cellist::Device::choose());
    const cellist::DeviceInfo& info = device.info();
    const bool gpu = info.is_gpu();
    if (options.nodes == 0) options.nodes = default_nodes(device, options.effort);
    if (options.threads == 0)
        options.threads =
            gpu ? std::max(1u, std::thread::hardware_concurrency()) : info.compute_units;
    bench::Suite suite(device, options.effort, options.nodes, options.occupancy, options.threads);
    benchmark::AddCustomContext("device", info.name);
    benchmark::AddCustomContext("platform", info.platform);
    benchmark::AddCustomContext("driver", info.driver);
    benchmark::AddCustomContext("kind", gpu ? "gpu" : "cpu");
    benchmark::AddCustomContext("bus", bench::bus_of(device));
    benchmark::AddCustomContext("compute_units", std::to_string(info.compute_units));
    benchmark::AddCustomContext("nodes", std::to_string(options.nodes));
    benchmark::AddCustomContext("occupancy", std::to_string(options.occupancy));
    benchmark::AddCustomContext("threads", std::to_string(options.threads));

    add_ceilings(suite);
    add_insert(suite);
    add_build(suite);
    add_append(suite);
    add_read(suite);
    add_storage(suite);
    add_sort(suite);
    add_sort_ties(suite);
    add_nearest(suite);
    add_pack(suite);
    add_clear(suite);
    if (!gpu) {
        add_peer_std_sort(suite);
        add_peer_counting_sort(suite);
#ifdef BENCH_TBB
        add_peer_parallel_sort(suite);
#endif
    }
#ifdef BENCH_BOOST_COMPUTE
    add_peer_boost_compute(suite);
#endif
    const bool ok = suite.run(out_file);
    benchmark::Shutdown();
    support::flush_standard_output();
    return ok ? 0 : 1;
} catch (const support::OutputClosed&) {
    return 1;
} catch (const std::exception& error) {
    std::cerr << "cellist_bench: " << error.what() << '\n';
    return 1;
}
