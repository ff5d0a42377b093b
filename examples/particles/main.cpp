// SPDX-License-Identifier: MIT
// Neighbour search with cell lists, checked against a k-d tree.
#include <algorithm>
#include <cstdio>
#include <iostream>
#include <limits>
#include <string>

#include <cellist/cellist.hpp>

#include "command_line.hpp"
#include "neighbour_search.hpp"
#include "reference.hpp"
#include "scene.hpp"
#include "stopwatch.hpp"

namespace {

struct Options {
    std::size_t points = 1'000'000;
    particles::Box box = particles::Box::periodic;
    cellist::Storage storage = cellist::Storage::counted;
    int cells_per_radius = 1;
    std::size_t check = 50'000;
    std::uint64_t runs = 3;
    std::uint32_t seed = 1;
    std::string device;
    std::string help;
};

particles::Box read_box(const std::string& text) {
    if (text == "periodic") return particles::Box::periodic;
    if (text == "open") return particles::Box::open;
    support::refuse("--box", text, "periodic or open");
}

Options parse_options(int count, const char* const* arguments) {
    Options options;
    support::CommandLine line("particles",
                              "Finds all neighbours of points within a radius, through per-cell "
                              "lists.");
    line.add_number("--points", options.points, 0, 100'000'000,
                    "number of points; each has about 30 neighbours");
    line.add("--box", "periodic", "boundary of space", "periodic|open",
             [&](const std::string& text) { options.box = read_box(text); });
    line.add_storage(options.storage);
    line.add_number("--cells", options.cells_per_radius, 1, 4, "cells along the radius", "1..4");
    line.add(
        "--check", std::to_string(options.check), "greatest number of points to check on the CPU",
        "N|all", [&](const std::string& text) {
            options.check = text == "all" ? options.points
                                          : support::read_number("--check", text, 0, 0xFFFFFFFF);
        });
    line.add_number("--runs", options.runs, 1, 1'000'000,
                    "timed runs, after a warm-up; the fastest counts");
    line.add_seed(options.seed);
    line.add_device(options.device);
    options.help = line.parse(count, arguments).value_or("");
    options.check = std::min(options.check, options.points);
    return options;
}

bool run(const Options& options) {
    constexpr double neighbours = 30;
    const cellist::Device device = options.device.empty() ? cellist::Device::choose()
                                                          : cellist::Device::choose(options.device);
    const particles::Scene scene =
        particles::make_scene(options.points, neighbours, options.box, options.seed);
    particles::NeighbourSearch search(device, scene, options.storage, options.cells_per_radius);

    cellist::BuildReport report = search.build();  // lets the pool grow
    search.find();
    support::Least build_ms, find_ms;
    for (std::uint64_t i = 0; i < options.runs; ++i) {
        build_ms.add(support::measure_ms(device, [&] { report = search.build(); }));
        find_ms.add(support::measure_ms(device, [&] { search.find(); }));
    }

    const std::vector<cl_uint2> found = search.found();
    std::uint64_t ends = 0;  // of pairs: each pair is found from both
    for (const cl_uint2& of_point : found) ends += of_point.s[0];
    std::printf("device      %s\n", device.info().name.c_str());
    std::printf("points      %zu, %s box, %llu rejected\n", options.points,
                options.box == particles::Box::open ? "open" : "periodic",
                static_cast<unsigned long long>(report.rejected));
    std::printf("lists       %s, %s cells, %.1f MB\n", name_of(options.storage),
                search.lists().shape().to_string().c_str(),
                static_cast<double>(search.lists().pool_bytes()) * 1e-6);
    std::printf(
        "pairs       %llu, %.1f neighbours per point\n", static_cast<unsigned long long>(ends / 2),
        static_cast<double>(ends) / static_cast<double>(std::max<std::size_t>(options.points, 1)));
    std::printf("time        build %.1f ms, all pairs %.1f ms, together %.1f ms\n", build_ms.ms(),
                find_ms.ms(), build_ms.ms() + find_ms.ms());

    const particles::Comparison comparison = particles::compare(scene, found, options.check);
    const bool accounted = report.rejected == scene.invalid && report.dropped == 0 &&
                           report.stored + report.rejected == options.points;
    std::printf("check       %s: neighbours of %zu points, %zu differ; records %s\n",
                comparison.method.c_str(), comparison.points, comparison.different,
                accounted ? "all accounted for" : "MISSING");
    return comparison.different == 0 && accounted;
}

}  // namespace

int main(int count, char** arguments) {
    return support::run_program("particles", [&] {
        const Options options = parse_options(count, arguments);
        if (options.help.empty()) return run(options);
        std::cout << options.help;
        return true;
    });
}
