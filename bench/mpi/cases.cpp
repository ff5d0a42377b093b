// SPDX-License-Identifier: MIT
#include "cases.hpp"

#include <array>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "bench_kernels.hpp"
#include "bytes_alone.hpp"
#include "stopwatch.hpp"
#include "support/distribution.h"
#include "support/timing.hpp"

namespace bench {

#include "input.h"

namespace {

cellist::Source source() {
    std::string text;
    for (const std::string_view part :
         {kernels::distribution_h, kernels::input_h, kernels::insert_cl})
        text.append(part).append("\n");
    return {.text = text, .file_name = "insert.cl"};
}

MpiInput input_of(const MpiCase& one, const cellist::mpi::Partition& partition) {
    const auto rank = static_cast<std::uint64_t>(partition.rank());
    const auto ranks = static_cast<std::uint64_t>(partition.ranks());
    const std::uint64_t first = one.records * rank / ranks;
    const std::uint64_t end = one.records * (rank + 1) / ranks;
    MpiInput input{.kind = one.kind,
                   .first = static_cast<cl_uint>(first),
                   .count = static_cast<cl_uint>(end - first)};
    const cellist::mpi::Block& block = partition.block();
    for (std::size_t axis = 0; axis < 3; ++axis) {
        input.extent[axis] = static_cast<cl_uint>(partition.shape().extent(axis));
        input.origin[axis] = static_cast<cl_uint>(block.origin[axis]);
        input.own[axis] = static_cast<cl_uint>(block.extent[axis]);
    }
    // Particles move along the last axis that is divided.
    for (std::size_t axis = 3; axis-- > 0;)
        if (input.own[axis] < input.extent[axis]) {
            input.step[axis] = input.own[axis];
            break;
        }
    return input;
}

// The same number of records, all in the rank's own cells.
MpiInput without_foreign(MpiInput input) {
    if (input.kind == MPI_RANDOM) input.kind = MPI_PARTICLES;
    for (cl_uint& step : input.step) step = 0;
    return input;
}

// The same input for a container that has only the rank's own cells.
MpiInput in_own_shape(MpiInput input) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        input.extent[axis] = input.own[axis];
        input.origin[axis] = 0;
    }
    return input;
}

// The records that this rank has for each other rank.
std::vector<std::uint64_t> foreign_records(const MpiInput& input,
                                           const cellist::mpi::Partition& partition) {
    std::vector<std::uint64_t> counts(static_cast<std::size_t>(partition.ranks()));
    if (partition.ranks() == 1 || input.kind == MPI_COHERENT) return counts;
    for (cl_uint i = 0; i < input.count; ++i) {
        const int owner = partition.owner(bench_mpi_cell(input, i));
        if (owner != partition.rank()) ++counts[static_cast<std::size_t>(owner)];
    }
    return counts;
}

std::uint64_t sum_of(MPI_Comm comm, std::uint64_t value) {
    MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_UINT64_T, MPI_SUM, comm);
    return value;
}

// The times of the slowest rank in milliseconds, by name: one for each run.
class SlowestTimes {
public:
    SlowestTimes(const cellist::Device& device, MPI_Comm comm) : device_(device), comm_(comm) {}

    void add(const std::string& name, double ms) {
        MPI_Allreduce(MPI_IN_PLACE, &ms, 1, MPI_DOUBLE, MPI_MAX, comm_);
        times_[name].push_back(ms);
    }
    void measure(const std::string& name, std::invocable auto&& work) {
        device_.finish();
        MPI_Barrier(comm_);
        add(name, support::measure_ms(device_, work));
    }
    void clear() { times_.clear(); }
    // Adds the median, the least and the greatest time of each name to a figure.
    void write(nlohmann::ordered_json& figure) const {
        for (const auto& [name, samples] : times_) {
            const Samples all = summary(samples);
            figure[name + "_ms"] = all.median;
            figure[name + "_least_ms"] = all.least;
            figure[name + "_greatest_ms"] = all.greatest;
        }
    }

private:
    const cellist::Device& device_;
    MPI_Comm comm_;
    std::map<std::string, std::vector<double>> times_;
};

void require(const std::string& what, std::uint64_t stored, std::uint64_t expected) {
    if (stored != expected)
        throw cellist::Error(what + " has " + std::to_string(stored) + " records instead of " +
                             std::to_string(expected));
}

}  // namespace

nlohmann::ordered_json measure(const cellist::Device& device, MPI_Comm comm, const MpiCase& one,
                               std::size_t runs) {
    int ranks = 1;
    MPI_Comm_size(comm, &ranks);
    const cellist::mpi::Partition partition(comm, one.shape,
                                            {.ghosts = 1, .periodic = {true, true, true}});
    const cellist::ListsOptions options{.storage = cellist::Storage::counted};
    const MpiInput input = input_of(one, partition), local = without_foreign(input);
    const MpiInput own = in_own_shape(local);
    const cellist::Range range = cellist::Range::padded(input.count);

    cellist::mpi::Lists<MpiRecord> lists(device, partition, options);
    cellist::Kernel insert(device, source(), "insert", lists, cellist::type<MpiInput>);
    cellist::Lists<MpiRecord> alone(device, {input.own[0], input.own[1], input.own[2]}, options);
    cellist::Kernel insert_alone(device, source(), "insert", alone, cellist::type<MpiInput>);
    const std::vector<std::uint64_t> foreign = foreign_records(input, partition);
    std::uint64_t sent = 0;
    for (const std::uint64_t count : foreign) sent += count;
    // A record travels with its cell.
    BytesAlone bytes(device, comm, foreign, sizeof(MpiRecord) + sizeof(cl_uint));

    const bool has_ghosts = one.input == "particles";
    std::uint64_t ghost_records = 0;
    SlowestTimes times(device, comm);
    for (std::size_t run = 0; run < runs + 2; ++run) {
        if (run == 2) times.clear();  // the first runs let pools grow
        cellist::BuildReport report;
        times.measure("build", [&] { report = lists.build(insert, range, input); });
        require("a build", report.stored, one.records);
        if (has_ghosts && ranks > 1) {
            times.measure("ghosts", [&] { lists.exchange_ghosts(); });
            if (run == 0) ghost_records = sum_of(comm, lists.local().lengths().total) - one.records;
        }
        times.measure("local", [&] { report = lists.build(insert, range, local); });
        require("a build without foreign records", report.stored, one.records);
        times.measure("alone", [&] { report = alone.build(insert_alone, range, own); });
        require("a build alone", report.stored, input.count);
        BytesAlone::Times steps;
        times.measure("bytes", [&] { steps = bytes.run(); });
        times.add("bytes_to_host", steps.to_host_ms);
        times.add("bytes_exchange", steps.exchange_ms);
        times.add("bytes_to_device", steps.to_device_ms);
    }

    nlohmann::ordered_json figure{{"scaling", one.scaling},
                                  {"input", one.input},
                                  {"ranks", ranks},
                                  {"records", one.records},
                                  {"cells", partition.shape().cells()},
                                  {"sent_records", sum_of(comm, sent)},
                                  {"record_bytes", sizeof(MpiRecord)},
                                  {"samples", runs}};
    if (has_ghosts) figure["ghost_records"] = ghost_records;
    times.write(figure);
    return figure;
}

}  // namespace bench
