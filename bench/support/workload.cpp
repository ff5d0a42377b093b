// SPDX-License-Identifier: MIT
#include "support/workload.hpp"

namespace bench {

cl_uint Workload::cells() const { return bench_cells(nodes, occupancy); }

double Workload::longest() const { return bench_longest(nodes, cells(), distribution.id); }

std::string Workload::name() const {
    return std::string("distribution:") + distribution.name +
           "/node_bytes:" + std::to_string(node_bytes) + "/occupancy:" + std::to_string(occupancy) +
           "/nodes:" + std::to_string(nodes);
}

Workload readable(Workload workload) {
    workload.nodes =
        bench_readable_nodes(workload.nodes, workload.occupancy, workload.distribution.id);
    return workload;
}

std::vector<Workload> random_and_coherent(std::vector<Workload> workloads) {
    std::erase_if(workloads, [](const Workload& workload) {
        const cl_uint id = workload.distribution.id;
        return id != BENCH_RANDOM && id != BENCH_COHERENT;
    });
    return workloads;
}

std::string Configuration::name() const {
    return "storage:" + storage + (allocation.empty() ? "" : "/allocation:" + allocation);
}

const std::vector<Configuration>& storages() {
    static const std::vector<Configuration> all{
        {"linked", "", {.storage = cellist::Storage::linked}},
        {"counted", "", {.storage = cellist::Storage::counted}},
        {"fixed", "", {.storage = cellist::Storage::fixed}},
    };
    return all;
}

const std::vector<Configuration>& automatic_storages() {
    static const std::vector<Configuration> all{
        {"automatic_1", "", {.storage = cellist::Storage::automatic, .expected_reads = 1}},
        {"automatic_8", "", {.storage = cellist::Storage::automatic, .expected_reads = 8}},
    };
    return all;
}

const std::vector<Configuration>& allocations() {
    static const std::vector<Configuration> all{
        {"linked", "sharded", {}},
        {"linked", "global", {}, "insert_with_one_counter"},
    };
    return all;
}

bool fits(const cellist::DeviceInfo& device, const Workload& workload,
          const Configuration& configuration) {
    const double cells = workload.cells();
    const double nodes = workload.nodes;
    const double record_bytes = 4.0 * workload.words();
    double pool_bytes = workload.node_bytes * nodes;
    if (configuration.options.storage == cellist::Storage::counted)
        pool_bytes = record_bytes * nodes;
    if (configuration.options.storage == cellist::Storage::fixed)
        pool_bytes = record_bytes * cells * workload.longest();
    // Beside the pool: heads, memory for the ceiling or a packed copy, and a reserve.
    return fits(device, pool_bytes, 3 * pool_bytes + 16 * cells);
}

bool fits(const cellist::DeviceInfo& device, double largest_bytes, double all_bytes) {
    return largest_bytes <= static_cast<double>(device.max_allocation_bytes) &&
           all_bytes <= 0.5 * static_cast<double>(device.global_memory_bytes);
}

}  // namespace bench
