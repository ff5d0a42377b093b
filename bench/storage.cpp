// SPDX-License-Identifier: MIT
// One build and one read of all lists for each storage, in host time.

#include <deque>

#include "support/containers.hpp"

namespace bench {

namespace {

template <class Record>
class BuildRead {
public:
    BuildRead(const Suite& suite, const Workload& workload, const Configuration& configuration,
              Input input, Caches caches, std::size_t interleaved = 1)
        : device_(suite.device()),
          workload_(workload),
          containers_(suite, workload, configuration, input, caches, interleaved),
          digests_(device_, workload.cells()),
          read_(device_, source_of<Record>(kernels::read_cl, "read.cl"), "read",
                containers_.next()) {}

    /// Seconds for a build, and for a read.
    std::pair<double, double> run() {
        cellist::Lists<Record>& lists = containers_.next();
        const double build = host_seconds(device_, [&] { containers_.build(lists); });
        const double read =
            host_seconds(device_, [&] { read_.run(workload_.cells(), lists, digests_); });
        return {build, read};
    }

    /// Nodes in the pool for each stored record.
    [[nodiscard]] double nodes_a_record() {
        return static_cast<double>(containers_.next().capacity_nodes()) / workload_.nodes;
    }

private:
    const cellist::Device& device_;
    Workload workload_;
    Containers<Record> containers_;
    cellist::Buffer<cl_uint> digests_;
    cellist::Kernel read_;
};

template <class Record>
Result build_read(const Suite& suite, const Workload& workload, const Configuration& configuration,
                  Input input) {
    // The alternatives reuse their memory, too.
    BuildRead<Record> work(suite, workload, configuration, input, Caches::warm);
    return build_and_read(suite.sampling(), workload.nodes, [&] { return work.run(); });
}

/// Calls `use` with each automatic storage and each storage that it may choose, by position.
template <class Use>
void for_each_choice(const std::vector<Configuration>& configurations, const Use& use) {
    const auto is_chosen = [&](std::size_t i) {
        return configurations[i].options.storage == cellist::Storage::automatic;
    };
    for (std::size_t i = 0; i < configurations.size(); ++i)
        for (std::size_t j = 0; j < configurations.size(); ++j)
            if (is_chosen(i) && !is_chosen(j)) use(i, j);
}

/// All storages and the automatic ones, interleaved, so that other work on the machine slows all of
/// them. The time of the case is that of one round. `automatic_1_to_linked` and similar figures are
/// medians of ratios within a round. A machine that is slow for some rounds changes them less than
/// the ratio of two medians.
Result compare_storages(const Suite& suite, const Workload& workload) {
    std::vector<Configuration> configurations = storages();
    configurations.insert(configurations.end(), automatic_storages().begin(),
                          automatic_storages().end());
    std::erase_if(configurations, [&](const Configuration& configuration) {
        return !fits(suite.device().info(), workload, configuration);
    });
    std::deque<BuildRead<Record12>> works;
    for (const Configuration& configuration : configurations)
        works.emplace_back(suite, workload, configuration, Input::generated, Caches::cold,
                           configurations.size());

    // The time of a round comes first, then build and read of each storage, then the ratios.
    const std::vector<Samples> samples = sample(suite.sampling(), [&] {
        std::vector<std::pair<double, double>> times;
        for (BuildRead<Record12>& work : works) times.push_back(work.run());
        std::vector<double> values{0};
        for (const auto& [build, read] : times) {
            values.insert(values.end(), {build, read});
            values[0] += build + read;
        }
        for_each_choice(configurations, [&](std::size_t chosen, std::size_t other) {
            const auto total = [&](std::size_t i) {
                return times[i].first +
                       configurations[chosen].options.expected_reads * times[i].second;
            };
            values.push_back(total(chosen) / total(other));
        });
        return values;
    });
    Result result{samples[0], double(workload.nodes), 0};
    for (std::size_t i = 0; i < works.size(); ++i) {
        const std::string& storage = configurations[i].storage;
        result.counters[storage + "_build_ms"] = 1e3 * samples[2 * i + 1].median;
        result.counters[storage + "_read_ms"] = 1e3 * samples[2 * i + 2].median;
        result.counters[storage + "_nodes_a_record"] = works[i].nodes_a_record();
    }
    auto ratio = samples.begin() + static_cast<std::ptrdiff_t>(2 * works.size() + 1);
    for_each_choice(configurations, [&](std::size_t chosen, std::size_t other) {
        result.counters[configurations[chosen].storage + "_to_" + configurations[other].storage] =
            (ratio++)->median;
    });
    return result;
}

/// The workloads of the comparison: 5 distributions by 5 occupancies at a quarter of the usual
/// size, or smaller, so that one work-item can read each list.
std::vector<Workload> storage_grid(const Suite& suite) {
    std::vector<cl_uint> occupancies{1, 4, 16, 64, 256};
    if (suite.effort() == Effort::tiny) occupancies = {4};
    std::vector<Workload> grid;
    for (const Distribution& distribution : distributions) {
        for (const cl_uint occupancy : occupancies) {
            Workload workload = suite.base(distribution);
            workload.occupancy = occupancy;
            workload.nodes /= 4;
            grid.push_back(readable(workload));
        }
    }
    return grid;
}

}  // namespace

void add_storage(Suite& suite) {
    add_cases(suite, "build_read/input:generated", suite.sorted_workloads(), storages(),
              []<class Record>(const Suite& s, const Workload& workload,
                               const Configuration& configuration) {
                  return build_read<Record>(s, workload, configuration, Input::generated);
              });
    add_cases(suite, "build_read/input:stored", suite.readable_bases(), storages(),
              []<class Record>(const Suite& s, const Workload& workload,
                               const Configuration& configuration) {
                  return build_read<Record>(s, workload, configuration, Input::stored);
              });
    for (const Workload& workload : storage_grid(suite))
        suite.add("storage/" + workload.name(),
                  [&suite, workload] { return compare_storages(suite, workload); });
}

}  // namespace bench
