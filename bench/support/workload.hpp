// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include <cellist/cellist.hpp>

#include "support/distribution.h"

namespace bench {

struct Distribution {
    const char* name;
    cl_uint id;
};
inline constexpr std::array distributions{
    Distribution{"random", BENCH_RANDOM}, Distribution{"coherent", BENCH_COHERENT},
    Distribution{"runs", BENCH_RUNS},     Distribution{"skewed", BENCH_SKEWED},
    Distribution{"hot", BENCH_HOT},
};
inline constexpr Distribution random = distributions[0];
inline constexpr Distribution coherent = distributions[1];
inline constexpr Distribution runs = distributions[2];
inline constexpr Distribution skewed = distributions[3];
inline constexpr Distribution hot = distributions[4];

/// A workload: `nodes` records in nodes / occupancy cells, which is a power of two.
struct Workload {
    Distribution distribution = random;
    cl_uint node_bytes = 16;  ///< record and link
    cl_uint occupancy = 16;   ///< nodes of a cell, on average
    cl_uint nodes = 0;

    [[nodiscard]] cl_uint cells() const;
    [[nodiscard]] cl_uint words() const { return node_bytes / 4 - 1; }  ///< of a record
    /// The approximate length of the longest list; an upper bound in all but rare cases.
    [[nodiscard]] double longest() const;
    /// The name in benchmarks: "distribution:random/node_bytes:16/...".
    [[nodiscard]] std::string name() const;
};

/// The same, halved until one work-item can traverse each list.
[[nodiscard]] Workload readable(Workload workload);

/// The workloads with random or coherent cells: the extremes for memory.
[[nodiscard]] std::vector<Workload> random_and_coherent(std::vector<Workload> workloads);

/// How lists are kept.
struct Configuration {
    std::string storage;     ///< as benchmarks are named
    std::string allocation;  ///< the same; empty for what the options take by default
    cellist::ListsOptions options;
    std::string kernel = "insert";  ///< in insert.cl

    [[nodiscard]] std::string name() const;
};

/// The storages, each with its default options.
[[nodiscard]] const std::vector<Configuration>& storages();
/// Storage::automatic, as automatic_1 and automatic_8 if it expects one read or eight.
[[nodiscard]] const std::vector<Configuration>& automatic_storages();
/// Linked lists with the library's sharded counters, and with the one counter of the papers.
[[nodiscard]] const std::vector<Configuration>& allocations();

/// Whether a device of this size has room for a container of a workload and its measurement.
[[nodiscard]] bool fits(const cellist::DeviceInfo& device, const Workload& workload,
                        const Configuration& configuration);

/// The same for arrays, by the bytes of the largest and of all together.
[[nodiscard]] bool fits(const cellist::DeviceInfo& device, double largest_bytes, double all_bytes);

}  // namespace bench
