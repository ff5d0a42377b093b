// SPDX-License-Identifier: MIT
// Bucket sort of keys with payloads, checked against std::sort.
#include <algorithm>
#include <cstdio>
#include <iostream>
#include <numeric>
#include <string>
#include <vector>

#include <cellist/cellist.hpp>

#include "bucket_sort.hpp"
#include "command_line.hpp"
#include "distributions.hpp"
#include "stopwatch.hpp"

namespace {

struct Options {
    std::size_t keys = 4'000'000;
    std::string distribution = "all";
    cellist::Storage storage = cellist::Storage::counted;
    std::uint64_t runs = 3;
    std::uint32_t seed = 1;
    std::string device;
    std::string help;
};

Options parse_options(int count, const char* const* arguments) {
    Options options;
    const auto& known = bucket_sort::distributions;
    std::string names;
    for (const auto name : known) names += std::string(name) + ", ";
    support::CommandLine line("bucket_sort",
                              "Sorts 32-bit keys with payloads through per-cell lists.");
    line.add_number("--keys", options.keys, 0, 1U << 31, "number of keys");
    line.add("--distribution", options.distribution, names + "or all", "NAME",
             [&](const std::string& text) {
                 if (text != "all" && std::find(known.begin(), known.end(), text) == known.end())
                     support::refuse("--distribution", text, names + "or all");
                 options.distribution = text;
             });
    line.add_storage(options.storage);
    line.add_number("--runs", options.runs, 1, 1'000'000,
                    "timed runs, after a warm-up; the fastest counts");
    line.add_seed(options.seed);
    line.add_device(options.device);
    options.help = line.parse(count, arguments).value_or("");
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
