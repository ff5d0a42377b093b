// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

#include <nlohmann/json.hpp>

#include <cellist/mpi.hpp>

#include "input.hpp"

namespace bench {

/// A workload, the same on all ranks.
struct MpiCase {
    std::string scaling;        ///< "weak" or "strong"
    std::string input;          ///< "random", "coherent" or "particles"
    cl_uint kind = 0;           ///< the same as in input.h
    std::uint64_t records = 0;  ///< of all ranks together
    cellist::Shape shape;       ///< in three dimensions
};

/// Measures builds and exchanges of ghost cells, and what they are compared with: builds of
/// cellist::Lists with the same number of records, and the bytes alone. Each time is that of the
/// slowest rank, in milliseconds. `runs` timed runs follow two that let the pools grow. Collective.
/// Blocks.
///
/// Returns the figure of the case: see bench/report/mpi.py. Throws Error if records are missing.
[[nodiscard]] nlohmann::ordered_json measure(const cellist::Device& device, MPI_Comm comm,
                                             const MpiCase& one, std::size_t runs);

}  // namespace bench
