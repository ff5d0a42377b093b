// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <deque>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <cellist/cellist.hpp>

#include "bench_kernels.hpp"
#include "support/oracle.hpp"
#include "support/records.hpp"
#include "support/suite.hpp"

namespace bench {

/// The source of a benchmark's kernels for a record, with the distributions before it.
template <class Record>
cellist::Source source_of(std::string_view kernels, const std::string& file_name) {
    return {.text = std::string(kernels::distribution_h) + std::string(kernels::record_clh) +
                    "#line 1 \"" + file_name + "\"\n" + std::string(kernels),
            .file_name = file_name,
            .options = "-DRECORD=Record" + std::to_string(sizeof(Record)) +
                       " -DBENCH_WORDS=" + std::to_string(words_of<Record>)};
}

/// Whether the kernel computes what it inserts, or reads it from arrays.
enum class Input { generated, stored };

/// Whether containers start with what the caches hold of the run before.
enum class Caches { cold, warm };

/// Containers of one workload, used in turn. They are filled and checked once. If a list is too
/// long for one work-item, fewer records of the same workload are checked instead.
template <class Record>
class Containers {
public:
    /// With cold caches, `interleaved` of these are used in turn, and together fill the caches.
    /// With warm ones there is one container. Throws std::runtime_error if the lists are wrong.
    Containers(const Suite& suite, const Workload& workload, const Configuration& configuration,
               Input input = Input::generated, Caches caches = Caches::cold,
               std::size_t interleaved = 1)
        : workload_(workload), options_(options_for(workload, configuration)) {
        const cellist::Device& device = suite.device();
        lists_.emplace_back(device, cellist::Shape{workload.cells()}, options_);
        insert_.emplace(device, source_of<Record>(kernels::insert_cl, "insert.cl"),
                        input == Input::stored ? "insert_stored" : configuration.kernel,
                        lists_.front());
        if (input == Input::stored) store_input(device);
        const cellist::BuildReport report = settle(lists_.front());
        if (report.stored != workload.nodes)
            throw std::runtime_error(std::to_string(report.stored) + " records are stored, not " +
                                     std::to_string(workload.nodes));
        const Workload checked = readable(workload);
        if (checked.nodes == workload.nodes)
            check(device, configuration);
        else
            Containers(suite, checked, configuration, input);

        while (caches == Caches::cold &&
               lists_.size() < suite.copies(interleaved * lists_.front().pool_bytes())) {
            lists_.emplace_back(device, cellist::Shape{workload.cells()}, options_);
            settle(lists_.back());
        }
    }

    [[nodiscard]] std::size_t size() const { return lists_.size(); }
    [[nodiscard]] cellist::Lists<Record>& next() {
        turn_ = (turn_ + 1) % lists_.size();
        return lists_[turn_];
    }

    /// Fills the lists again. Blocks.
    cellist::BuildReport build(cellist::Lists<Record>& lists) {
        return lists.build([&] { run_insert(lists); });
    }

    /// Adds the first `nodes` records once more. Blocks.
    cellist::BuildReport append(cellist::Lists<Record>& lists, cl_uint nodes) {
        return lists.append([&] {
            insert_->run(cellist::Range::padded(nodes), lists, workload_.distribution.id, nodes);
        });
    }

    /// Fills the lists again. Returns the device time of each run of the inserting kernel.
    [[nodiscard]] std::vector<double> insert_seconds(cellist::Lists<Record>& lists) {
        std::vector<cl::Event> events;
        lists.build([&] { events.push_back(run_insert(lists)); });
        std::vector<double> seconds;
        for (const cl::Event& event : events) seconds.push_back(device_seconds(event));
        return seconds;
    }

private:
    static cellist::ListsOptions options_for(const Workload& workload,
                                             const Configuration& configuration) {
        cellist::ListsOptions options = configuration.options;
        options.capacity_nodes = workload.nodes;
        if (options.storage == cellist::Storage::fixed) options.slots = expected(workload).longest;
        return options;
    }

    cl::Event run_insert(cellist::Lists<Record>& lists) {
        if (stored_)
            return insert_->run(cellist::Range::padded(workload_.nodes), lists, stored_->first,
                                stored_->second, workload_.nodes);
        return insert_->run(cellist::Range::padded(workload_.nodes), lists,
                            workload_.distribution.id, workload_.nodes);
    }

    /// Makes the first build; in Storage::automatic, all builds of its trial, at most twelve.
    cellist::BuildReport settle(cellist::Lists<Record>& lists) {
        const bool automatic = options_.storage == cellist::Storage::automatic;
        for (int i = 0; automatic && i < 12; ++i) build(lists);
        return build(lists);
    }

    void store_input(const cellist::Device& device) {
        stored_.emplace(cellist::Buffer<cl_uint>(device, workload_.nodes),
                        cellist::Buffer<Record>(device, workload_.nodes));
        cellist::Kernel store(device, source_of<Record>(kernels::input_cl, "input.cl"),
                              "store_input", cellist::type<Record>);
        store.run(workload_.nodes, stored_->first, stored_->second, workload_.cells(),
                  workload_.distribution.id);
    }

    void check(const cellist::Device& device, const Configuration& configuration) {
        cellist::Lists<Record>& lists = lists_.front();
        // A kernel with a counter of its own leaves the counters of the shards wrong.
        if (configuration.kernel == "insert")
            if (const cellist::Validation found = lists.validate(); !found.ok())
                throw std::runtime_error(found.message());
        cellist::Kernel read(device, source_of<Record>(kernels::read_cl, "read.cl"), "read", lists);
        cellist::Buffer<cl_uint> digests(device, workload_.cells());
        read.run(workload_.cells(), lists, digests);
        check_digests(digests.download(), expected(workload_).digests);
    }

    Workload workload_;
    cellist::ListsOptions options_;
    std::deque<cellist::Lists<Record>> lists_;
    std::optional<cellist::Kernel> insert_;
    std::optional<std::pair<cellist::Buffer<cl_uint>, cellist::Buffer<Record>>> stored_;
    std::size_t turn_ = 0;
};

/// Adds a case for each workload and configuration that fit the device. Calls
/// measure.operator()<Record>(suite, workload, configuration).
template <class Measure>
void add_cases(Suite& suite, const std::string& name, const std::vector<Workload>& workloads,
               const std::vector<Configuration>& configurations, const Measure& measure) {
    for (const Configuration& configuration : configurations) {
        for (const Workload& workload : workloads) {
            if (!fits(suite.device().info(), workload, configuration)) continue;
            suite.add(name + "/" + configuration.name() + "/" + workload.name(), [=, &suite] {
                return with_record(workload.node_bytes, [&]<class Record>() {
                    return measure.template operator()<Record>(suite, workload, configuration);
                });
            });
        }
    }
}

}  // namespace bench
