// SPDX-License-Identifier: MIT
// Compares distributed lists with lists of one device, and with a plain exchange of the same bytes.
// scripts/bench mpi runs it with several numbers of ranks and reports the results. CELLIST_DEVICE
// names the device.
#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include "command_line.hpp"
#include "files.hpp"
#include "mpi/cases.hpp"
#include "mpi_job.hpp"
#include "support/bus.hpp"

namespace {

struct Options {
    std::uint64_t weak_bits = 0;
    std::uint64_t strong_bits = 0;
    std::size_t runs = 9;
    std::filesystem::path json = {};
    std::string help = {};
};

Options parse(int count, const char* const* arguments) {
    Options options;
    support::CommandLine line("cellist_bench_mpi",
                              "Measures builds and exchanges of lists over the ranks of mpirun.");
    const auto add_bits = [&](const char* name, std::uint64_t& bits, const char* what) {
        line.add(name, "", what, "BITS", [&bits, name](const std::string& text) {
            bits = support::read_number(name, text, 8, 28);
        });
    };
    add_bits("--weak", options.weak_bits, "weak scaling, with 2^BITS records on each rank");
    add_bits("--strong", options.strong_bits, "strong scaling, with 2^BITS records in all");
    line.add_number("--runs", options.runs, 1, 1000, "timed runs of each case, after a warm-up");
    line.add_text("--json", options.json, "write the results to this file", "FILE");
    options.help = line.parse(count, arguments).value_or("");
    return options;
}

// Cells for 2^bits records per box, 16 to a cell: a column of `copies` boxes that are nearly cubes.
cellist::Shape shape_for(std::uint64_t bits, std::uint64_t copies) {
    const std::uint64_t cell_bits = bits - 4;
    const auto side = [&](std::uint64_t axis) {
        return std::uint64_t{1} << (cell_bits + 2 - axis) / 3;
    };
    return {side(0), side(1), copies * side(2)};
}

std::vector<bench::MpiCase> cases(const Options& options, std::uint64_t ranks) {
    constexpr const char* inputs[] = {"random", "coherent", "particles"};  // as in input.h
    std::vector<bench::MpiCase> all;
    const auto add = [&](const char* scaling, std::uint64_t bits, std::uint64_t copies) {
        for (cl_uint kind = 0; kind < 3 && bits > 0; ++kind)
            all.push_back({scaling, inputs[kind], kind, copies << bits, shape_for(bits, copies)});
    };
    add("weak", options.weak_bits, ranks);
    add("strong", options.strong_bits, 1);
    return all;
}

std::string library() {
    char text[MPI_MAX_LIBRARY_VERSION_STRING] = {};
    int length = 0;
    MPI_Get_library_version(text, &length);
    const std::string whole(text, static_cast<std::size_t>(length));
    return whole.substr(0, whole.find_first_of(",\n"));
}

void run(const Options& options, const support::MpiJob& job) {
    const cellist::Device device = cellist::mpi::choose(MPI_COMM_WORLD);
    const cellist::DeviceInfo& info = device.info();
    const bool gpu = info.is_gpu();
    nlohmann::ordered_json results{
        {"device", info.name},
        {"platform", info.platform},
        {"driver", info.driver},
        {"kind", gpu ? "gpu" : "cpu"},
        {"threads", info.compute_units},
        {"devices", support::devices_of_all_ranks(info.name + " " + bench::bus_of(device))},
        {"mpi", library()},
        {"ranks", job.ranks()}};
    for (const bench::MpiCase& one : cases(options, static_cast<std::uint64_t>(job.ranks())))
        results["figures"].push_back(bench::measure(device, MPI_COMM_WORLD, one, options.runs));
    if (!job.is_first()) return;
    if (options.json.empty())
        std::cout << results.dump(1) << '\n';
    else
        support::write_file(options.json, results.dump(1) + '\n');
}

}  // namespace

int main(int count, char** arguments) {
    return support::run_program("cellist_bench_mpi", [&] {
        const Options options = parse(count, arguments);
        if (!options.help.empty()) {
            std::cout << options.help;
            return true;
        }
        support::MpiJob job("cellist_bench_mpi");
        return job.run([&] {
            run(options, job);
            return true;
        });
    });
}
