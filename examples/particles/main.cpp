// SPDX-License-Identifier: MIT
// Neighbour search with cell lists, on one device or over MPI, checked against a k-d tree.
#include <algorithm>
#include <cstdio>
#include <iostream>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <cellist/cellist.hpp>

#include "command_line.hpp"
#include "neighbour_search.hpp"
#include "reference.hpp"
#include "scene.hpp"
#include "stopwatch.hpp"
#ifdef CELLIST_EXAMPLE_MPI
#include "distributed_search.hpp"
#include "mpi_job.hpp"
#endif

namespace {

struct Options {
    std::size_t points = 1'000'000;
    particles::Box box = particles::Box::periodic;
    cellist::Storage storage = cellist::Storage::counted;
    int cells_per_radius = 1;
    std::size_t check = 50'000;
    std::uint64_t runs = 3;
    std::uint32_t seed = 1;
    bool mpi = false;
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
    line.add_flag("--mpi", options.mpi, "divide the cells between the ranks of mpirun");
    options.help = line.parse(count, arguments).value_or("");
    options.check = std::min(options.check, options.points);
    return options;
}

// The least times of the parts of a step.
using Times = std::vector<std::pair<std::string, support::Least>>;

struct Measured {
    std::string device;
    int ranks = 1;
    cellist::BuildReport report = {};  ///< of the first build
    std::string cells = {};
    double megabytes = 0;  ///< of the lists, on one device
    Times times = {};
    std::vector<cl_uint2> found = {};
};

cellist::Device choose_device(const Options& options) {
    return options.device.empty() ? cellist::Device::choose()
                                  : cellist::Device::choose(options.device);
}

Measured measure(const Options& options, const particles::Scene& scene) {
    const cellist::Device device = choose_device(options);
    particles::NeighbourSearch search(device, scene, options.storage, options.cells_per_radius);
    Measured measured{.device = device.info().name, .times = {{"build", {}}, {"all pairs", {}}}};
    measured.report = search.build();  // lets the pool grow
    search.find();
    for (std::uint64_t i = 0; i < options.runs; ++i) {
        measured.times[0].second.add(support::measure_ms(device, [&] { search.build(); }));
        measured.times[1].second.add(support::measure_ms(device, [&] { search.find(); }));
    }
    measured.cells = search.lists().shape().to_string();
    measured.megabytes = static_cast<double>(search.lists().pool_bytes()) * 1e-6;
    measured.found = search.found();
    return measured;
}

#ifdef CELLIST_EXAMPLE_MPI

// The time until the slowest rank is ready.
double measure_on_ranks(const cellist::Device& device, std::invocable auto&& work) {
    device.finish();
    MPI_Barrier(MPI_COMM_WORLD);
    double ms = support::measure_ms(device, work);
    MPI_Allreduce(MPI_IN_PLACE, &ms, 1, MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD);
    return ms;
}

Measured measure_distributed(const Options& options, const particles::Scene& scene) {
    const cellist::Device device =
        options.device.empty() ? cellist::mpi::choose(MPI_COMM_WORLD) : choose_device(options);
    particles::DistributedSearch search(device, scene, options.storage, options.cells_per_radius);
    const cellist::mpi::Lists<particles::Particle>& lists = search.lists();
    Measured measured{.device = support::devices_of_all_ranks(device.info().name),
                      .ranks = lists.partition().ranks(),
                      .times = {{"build", {}}, {"ghosts", {}}, {"all pairs", {}}}};
    measured.report = search.build();  // brings all points to their ranks
    search.keep_own_points();
    for (int step = 0; step < 2; ++step) {  // lets pools grow, and compiles the last kernels
        search.exchange_ghosts();
        search.find();
        search.build();
    }
    for (std::uint64_t i = 0; i < options.runs; ++i) {
        Times& times = measured.times;
        times[0].second.add(measure_on_ranks(device, [&] { search.build(); }));
        times[1].second.add(measure_on_ranks(device, [&] { search.exchange_ghosts(); }));
        times[2].second.add(measure_on_ranks(device, [&] { search.find(); }));
    }
    measured.cells = lists.shape().to_string();
    measured.megabytes = static_cast<double>(lists.local().pool_bytes()) * 1e-6;
    measured.found = search.found();
    return measured;
}

#endif

// Prints the results and checks them.
bool report(const Options& options, const particles::Scene& scene, const Measured& measured) {
    std::uint64_t ends = 0;  // of pairs: each pair is found from both
    for (const cl_uint2& of_point : measured.found) ends += of_point.s[0];
    std::printf("device      %s\n", measured.device.c_str());
    if (options.mpi) std::printf("ranks       %d\n", measured.ranks);
    std::printf("points      %zu, %s box, %llu rejected\n", options.points,
                options.box == particles::Box::open ? "open" : "periodic",
                static_cast<unsigned long long>(measured.report.rejected));
    std::printf("lists       %s, %s cells, %.1f MB\n", name_of(options.storage),
                measured.cells.c_str(), measured.megabytes);
    std::printf(
        "pairs       %llu, %.1f neighbours per point\n", static_cast<unsigned long long>(ends / 2),
        static_cast<double>(ends) / static_cast<double>(std::max<std::size_t>(options.points, 1)));
    double together_ms = 0;
    std::printf("time        ");
    for (const auto& [part, least] : measured.times) {
        std::printf("%s %.1f ms, ", part.c_str(), least.ms());
        together_ms += least.ms();
    }
    std::printf("together %.1f ms\n", together_ms);

    const particles::Comparison comparison =
        particles::compare(scene, measured.found, options.check);
    const bool accounted = measured.report.rejected == scene.invalid &&
                           measured.report.dropped == 0 &&
                           measured.report.stored + measured.report.rejected == options.points;
    std::printf("check       %s: neighbours of %zu points, %zu differ; records %s\n",
                comparison.method.c_str(), comparison.points, comparison.different,
                accounted ? "all accounted for" : "MISSING");
    return comparison.different == 0 && accounted;
}

bool run(const Options& options) {
    constexpr double neighbours = 30;
    const auto make_scene = [&] {
        return particles::make_scene(options.points, neighbours, options.box, options.seed);
    };
    if (options.mpi) {
#ifdef CELLIST_EXAMPLE_MPI
        support::MpiJob job("particles");
        return job.run([&] {
            const particles::Scene scene = make_scene();
            const Measured measured = measure_distributed(options, scene);
            return !job.is_first() || report(options, scene, measured);
        });
#else
        support::refuse_mpi();
#endif
    }
    const particles::Scene scene = make_scene();
    return report(options, scene, measure(options, scene));
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
