// SPDX-License-Identifier: MIT
#pragma once

// The least number of bytes that operations must move: records, nodes, heads, counters and results,
// with each necessary read and write. Small amounts are left out. The rates of these bytes are
// compared with the rate of a copy.

#include <cstddef>

#include "support/workload.hpp"

namespace bench {

/// All `kernel_runs` runs of the inserting kernel together. They store the records, and read and
/// write a head or a counter for each. Storage::counted in two runs also counts first, and reads an
/// offset for each record. In one run it only stores nodes.
[[nodiscard]] double insert_bytes(const Workload& workload, const Configuration& configuration,
                                  std::size_t kernel_runs);
/// Clears the lists, inserts, and moves the records after a single pass into Storage::counted.
[[nodiscard]] double build_bytes(const Workload& workload, const Configuration& configuration,
                                 std::size_t kernel_runs);
/// Traverses every list: the records, with their links if there are any, the heads or offsets, and
/// a result for each cell.
[[nodiscard]] double read_bytes(const Workload& workload, const Configuration& configuration);
/// Every record is read and written.
[[nodiscard]] double sort_bytes(const Workload& workload);
/// The lists are traversed, and their records and offsets written.
[[nodiscard]] double pack_bytes(const Workload& workload, const Configuration& configuration);

}  // namespace bench
