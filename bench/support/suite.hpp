// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <cellist/cellist.hpp>

#include "support/timing.hpp"
#include "support/workload.hpp"

namespace bench {

/// How much is measured.
enum class Effort {
    tiny,   ///< every kind of case once, as a test of the benchmarks
    quick,  ///< what the ratios need, at a quarter of the size
    full,   ///< also other sizes, for plots, and fewer records in the same cells
};

/// The result of a case. Its time is the median.
struct Result {
    Samples samples;
    double nodes = 0;  ///< that were processed
    double bytes = 0;  ///< that at least have to be moved
    std::map<std::string, double> counters = {};
};

/// The result of a build and a read of `nodes` records. `run` returns the seconds of both. The time
/// of the case is their sum. The counters build_ms and read_ms are the medians of each.
[[nodiscard]] Result build_and_read(const Sampling& sampling, double nodes,
                                    const std::function<std::pair<double, double>()>& run);

/// The device, the effort, and the cases. Each file of benchmarks adds its cases. Google Benchmark
/// runs and reports them.
class Suite {
public:
    Suite(const cellist::Device& device, Effort effort, cl_uint nodes, cl_uint occupancy,
          unsigned threads);

    [[nodiscard]] const cellist::Device& device() const { return device_; }
    [[nodiscard]] Effort effort() const { return effort_; }
    /// Of the C++ peers.
    [[nodiscard]] unsigned threads() const { return threads_; }
    [[nodiscard]] const Sampling& sampling() const { return sampling_; }

    /// The number of copies to use in turn, so that caches do not hold all of them. Together they
    /// take 128 MiB, but there are at most 256.
    [[nodiscard]] std::uint64_t copies(std::uint64_t bytes) const;

    /// The workload of the ratios.
    [[nodiscard]] Workload base(const Distribution& distribution) const;
    /// The base workload with each distribution, unless a list is longer than `longest`.
    [[nodiscard]] std::vector<Workload> bases(
        double longest = std::numeric_limits<double>::infinity()) const;
    /// The base workload with each distribution, for comparison with peers. It is halved until one
    /// work-item can traverse each list.
    [[nodiscard]] std::vector<Workload> readable_bases() const;
    /// For comparison with sorts on the same device: readable_bases(). Full effort adds the same
    /// cells with a quarter of the records.
    [[nodiscard]] std::vector<Workload> sorted_workloads() const;
    /// The base workload with each distribution. Full effort adds each size from 2^12 to 2^26. For
    /// random and coherent cells, it also adds each node size and several occupancies.
    [[nodiscard]] std::vector<Workload> workloads() const;

    /// Adds a case. `measure` sets up, checks the results once, and measures. If it throws, the
    /// case fails. A second case of the same name is left out.
    void add(const std::string& name, std::function<Result()> measure);

    /// Runs the cases that Google Benchmark's options select, and writes the results as JSON unless
    /// `out` is empty. Returns whether all succeeded. Throws as support::write_file() does.
    [[nodiscard]] bool run(const std::filesystem::path& out);

private:
    const cellist::Device& device_;
    Effort effort_;
    cl_uint nodes_;
    cl_uint occupancy_;
    unsigned threads_;
    Sampling sampling_;
    std::map<std::string, std::function<Result()>> cases_;
    std::size_t failures_ = 0;
};

void add_insert(Suite& suite);
void add_build(Suite& suite);
void add_append(Suite& suite);
void add_read(Suite& suite);
void add_sort(Suite& suite);
void add_sort_ties(Suite& suite);
void add_storage(Suite& suite);
void add_nearest(Suite& suite);
void add_pack(Suite& suite);
void add_clear(Suite& suite);
void add_ceilings(Suite& suite);
void add_peer_std_sort(Suite& suite);
void add_peer_counting_sort(Suite& suite);
void add_peer_parallel_sort(Suite& suite);
void add_peer_boost_compute(Suite& suite);

}  // namespace bench
