#pragma once

// Bytes that operations have to move at least: records, nodes, heads, counters and results, each read
// and written as often as it must be. What is small beside them is left out. Rates are of these bytes,
// and are compared with the rate of a copy.

#include <cstddef>

#include "support/workload.hpp"

namespace bench {

/// All runs of the inserting kernel together, of which there were `kernel_runs`: storing the records, and
/// reading and writing a head or a counter for each. Storage::counted in two runs also counts first, and
/// reads an offset for each; in one run it only stores nodes.
[[nodiscard]] double insert_bytes(const Workload& workload, const Keeping& keeping,
                                  std::size_t kernel_runs);
/// Emptying the lists, inserting, and moving the records where there is a single pass into Storage::counted.
[[nodiscard]] double build_bytes(const Workload& workload, const Keeping& keeping,
                                 std::size_t kernel_runs);
/// Walking every list: the records, with their links where there are some, the heads or offsets, and a
/// result for each cell.
[[nodiscard]] double read_bytes(const Workload& workload, const Keeping& keeping);
/// Every record is read and written.
[[nodiscard]] double sort_bytes(const Workload& workload);
/// The lists are walked, and their records and offsets written.
[[nodiscard]] double pack_bytes(const Workload& workload, const Keeping& keeping);

}  // namespace bench
