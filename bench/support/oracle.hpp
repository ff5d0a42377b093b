// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "support/workload.hpp"

namespace bench {

/// The expected content of a workload's lists, from plain C++.
struct Expected {
    std::vector<cl_uint> digests;  ///< of each cell: see support/record.clh
    cl_uint longest = 0;           ///< nodes of the longest list
};

/// Computed once for each workload.
[[nodiscard]] const Expected& expected(const Workload& workload);

/// For each cell, the sum of the digests of the `k` records with the least keys. Computed once.
[[nodiscard]] const std::vector<cl_uint>& expected_nearest(const Workload& workload, cl_uint k);

/// Throws std::runtime_error, with the first cell that differs, unless the digests are as expected.
void check_digests(const std::vector<cl_uint>& digests, const std::vector<cl_uint>& expected);

}  // namespace bench
