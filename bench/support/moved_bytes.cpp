// SPDX-License-Identifier: MIT
#include "support/moved_bytes.hpp"

namespace bench {

namespace {

double records_bytes(const Workload& workload) { return 4.0 * workload.words() * workload.nodes; }

double nodes_bytes(const Workload& workload) { return 1.0 * workload.node_bytes * workload.nodes; }

double word_of_cells(const Workload& workload) { return 4.0 * workload.cells(); }

}  // namespace

double insert_bytes(const Workload& workload, const Configuration& configuration,
                    std::size_t kernel_runs) {
    const double nodes = workload.nodes;
    switch (configuration.options.storage) {
        case cellist::Storage::linked:
            return nodes_bytes(workload) + 8 * nodes;
        case cellist::Storage::counted:
            return kernel_runs == 1 ? nodes_bytes(workload)
                                    : records_bytes(workload) + (8 + 12) * nodes;
        default:
            return records_bytes(workload) + 8 * nodes;
    }
}

double build_bytes(const Workload& workload, const Configuration& configuration,
                   std::size_t kernel_runs) {
    const double bytes =
        word_of_cells(workload) + insert_bytes(workload, configuration, kernel_runs);
    const bool moved =
        configuration.options.storage == cellist::Storage::counted && kernel_runs == 1;
    return moved ? bytes + nodes_bytes(workload) + records_bytes(workload) : bytes;
}

double read_bytes(const Workload& workload, const Configuration& configuration) {
    const bool linked = configuration.options.storage == cellist::Storage::linked;
    return (linked ? nodes_bytes(workload) : records_bytes(workload)) + 2 * word_of_cells(workload);
}

double sort_bytes(const Workload& workload) { return 2 * records_bytes(workload); }

double pack_bytes(const Workload& workload, const Configuration& configuration) {
    return read_bytes(workload, configuration) + records_bytes(workload);
}

}  // namespace bench
