// Bucket sort of keys with payloads, checked against std::sort.
#include <algorithm>
#include <cstdio>
#include <iostream>
#include <numeric>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include <cellist/cellist.hpp>

#include "bucket_sort.hpp"
#include "command_line.hpp"
#include "distributions.hpp"
#include "stopwatch.hpp"

namespace {

struct Options {
    std::size_t keys = 0;
    std::string distribution;
    cellist::Storage storage = cellist::Storage::counted;
    std::uint64_t runs = 0;
    std::uint32_t seed = 0;
    std::string device;
    std::string help;
};

Options parse_options(int count, const char* const* arguments) {
    using support::read_number;
    Options options;
    std::string keys = "4000000", storage = "counted", runs = "3", seed = "1";
    options.distribution = "all";
    std::string names;
    for (const auto name : bucket_sort::distributions) names += std::string(name) + ", ";
    CLI::App app{"Sorts 32-bit keys with payloads through per-cell lists.", "bucket_sort"};
    app.add_option("--keys", keys, "number of keys")->type_name("N")->capture_default_str();
    app.add_option("--distribution", options.distribution, names + "or all")
        ->type_name("NAME")
        ->capture_default_str();
    app.add_option("--storage", storage, "storage of the lists")
        ->type_name("linked|counted|fixed")
        ->capture_default_str();
    app.add_option("--runs", runs, "timed runs, after a warm-up; the fastest counts")
        ->type_name("N")
        ->capture_default_str();
    app.add_option("--seed", seed, "seed of the random numbers")
        ->type_name("N")
        ->capture_default_str();
    app.add_option("--device", options.device,
                   "device, by index or part of its name; the default is CELLIST_DEVICE, a GPU, or "
                   "the first")
        ->type_name("D");
    if (const auto help = support::parse_command_line(app, count, arguments)) {
        options.help = *help;
        return options;
    }
    options.keys = read_number("--keys", keys, 0, 1U << 31);
    options.storage = support::read_storage("--storage", storage);
    options.runs = read_number("--runs", runs, 1, 1'000'000);
    options.seed = static_cast<std::uint32_t>(read_number("--seed", seed, 0, 0xFFFFFFFF));
    const auto& known = bucket_sort::distributions;
    if (options.distribution != "all" &&
        std::find(known.begin(), known.end(), options.distribution) == known.end())
        support::refuse("--distribution", options.distribution, names + "or all");
    return options;
}

bool sort_one(const cellist::Device& device, const Options& options, std::size_t distribution) {
    const std::vector<cl_uint> keys =
        bucket_sort::make_keys(distribution, options.keys, options.seed);
    std::vector<cl_uint> positions(keys.size());
    std::iota(positions.begin(), positions.end(), cl_uint{0});
    std::vector<bucket_sort::Record> expected;
    expected.reserve(keys.size());
    for (std::size_t i = 0; i < keys.size(); ++i) expected.push_back({keys[i], positions[i]});
    const support::Stopwatch stopwatch;
    std::sort(expected.begin(), expected.end());
    const double std_ms = stopwatch.ms();

    const cellist::Buffer<cl_uint> device_keys(device, keys), payloads(device, positions);
    bucket_sort::BucketSort sort(device, keys.size(), options.storage);
    const auto limit = std::max<std::uint64_t>(keys.size(), 1);
    cellist::Buffer<bucket_sort::Record> sorted = sort.sort(device_keys, payloads, limit);
    bucket_sort::Times best;
    for (std::uint64_t run = 0; run < options.runs; ++run) {
        sorted = sort.sort(device_keys, payloads, limit);
        if (run == 0 || sort.times().sum() < best.sum()) best = sort.times();
    }
    const std::vector<bucket_sort::Record> result = sorted.download();
    const bool equal = result == expected;
    const double count = static_cast<double>(keys.size());
    std::printf("%-11s %9.1f %8.1f %8.1f %8.1f %8.1f %10.1f %10.1f %8llu  %s\n",
                std::string(bucket_sort::distributions[distribution]).c_str(), best.sum(),
                best.sample_ms, best.insert_ms, best.sort_ms, best.pack_ms,
                count / best.sum() * 1e-3, count / std_ms * 1e-3,
                static_cast<unsigned long long>(sort.buckets().lengths().longest),
                equal ? "equal" : "DIFFERENT");
    return equal;
}

bool run(const Options& options) {
    const cellist::Device device = options.device.empty() ? cellist::Device::choose()
                                                          : cellist::Device::choose(options.device);
    std::printf("%zu keys with payloads, %s lists, %s\n", options.keys, name_of(options.storage),
                device.info().name.c_str());
    std::printf("%-11s %9s %8s %8s %8s %8s %10s %10s %8s  %s\n", "keys", "total ms", "sample",
                "insert", "sort", "pack", "M keys/s", "std::sort", "longest", "result");
    bool equal = true;
    for (std::size_t i = 0; i < bucket_sort::distributions.size(); ++i)
        if (options.distribution == "all" || options.distribution == bucket_sort::distributions[i])
            equal = sort_one(device, options, i) && equal;
    return equal;
}

}  // namespace

int main(int count, char** arguments) {
    return support::run_program("bucket_sort", [&] {
        const Options options = parse_options(count, arguments);
        if (options.help.empty()) return run(options);
        std::cout << options.help;
        return true;
    });
}
