// Neighbour search with cell lists, checked against a k-d tree.
#include <algorithm>
#include <cstdio>
#include <iostream>
#include <limits>
#include <string>

#include <CLI/CLI.hpp>

#include <cellist/cellist.hpp>

#include "command_line.hpp"
#include "neighbour_search.hpp"
#include "reference.hpp"
#include "scene.hpp"
#include "stopwatch.hpp"

namespace {

struct Options {
    std::size_t points = 0;
    particles::Box box = particles::Box::periodic;
    cellist::Storage storage = cellist::Storage::counted;
    int cells_per_radius = 1;
    std::size_t check = 0;
    std::uint64_t runs = 0;
    std::uint32_t seed = 0;
    std::string device;
    std::string help;
};

particles::Box read_box(const std::string& text) {
    if (text == "periodic") return particles::Box::periodic;
    if (text == "open") return particles::Box::open;
    support::refuse("--box", text, "periodic or open");
}

Options parse_options(int count, const char* const* arguments) {
    using support::read_number;
    Options options;
    std::string points = "1000000", box = "periodic", storage = "counted", cells = "1",
                check = "50000", runs = "3", seed = "1";
    CLI::App app{"Finds all neighbours of points within a radius, through per-cell lists.",
                 "particles"};
    app.add_option("--points", points, "number of points; each has about 30 neighbours")
        ->type_name("N")
        ->capture_default_str();
    app.add_option("--box", box, "boundary of space")
        ->type_name("periodic|open")
        ->capture_default_str();
    app.add_option("--storage", storage, "storage of the lists")
        ->type_name("linked|counted|fixed")
        ->capture_default_str();
    app.add_option("--cells", cells, "cells along the radius")
        ->type_name("1..4")
        ->capture_default_str();
    app.add_option("--check", check, "greatest number of points to check on the CPU")
        ->type_name("N|all")
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
    options.points = read_number("--points", points, 0, 100'000'000);
    options.box = read_box(box);
    options.storage = support::read_storage("--storage", storage);
    options.cells_per_radius = static_cast<int>(read_number("--cells", cells, 1, 4));
    options.check = check == "all" ? options.points : read_number("--check", check, 0, 0xFFFFFFFF);
    options.check = std::min(options.check, options.points);
    options.runs = read_number("--runs", runs, 1, 1'000'000);
    options.seed = static_cast<std::uint32_t>(read_number("--seed", seed, 0, 0xFFFFFFFF));
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
        "pairs       %llu, %.1f neighbours a point\n", static_cast<unsigned long long>(ends / 2),
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
