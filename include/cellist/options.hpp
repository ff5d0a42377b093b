#pragma once

#include <cstdint>
#include <limits>
#include <optional>

namespace cellist {

/// What a build does when the pool is full.
enum class Overflow {
    grow,  ///< enlarge the pool to the exact demand and run again
    stop,  ///< throw OverflowError; the lists are empty
    drop,  ///< keep what fits; the report counts what was dropped, and every list is valid
};

/// How kernels get nodes from the pool.
enum class Allocation {
    sharded,  ///< up to 256 counters, probed in turn when one runs out
    global,   ///< one counter; slower wherever many work-items insert, for comparison
};

struct ListsOptions {
    Overflow overflow = Overflow::grow;
    /// Nodes in the pool at first. Without it the pool starts at one node a cell, at least 65,536,
    /// under Overflow::grow; the other policies need it.
    std::optional<std::uint64_t> capacity_nodes = {};
    /// Device memory that heads, nodes and counters may take together.
    std::uint64_t budget_bytes = std::numeric_limits<std::uint64_t>::max();
    Allocation allocation = Allocation::sharded;
};

}  // namespace cellist
