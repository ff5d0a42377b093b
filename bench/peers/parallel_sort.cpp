// SPDX-License-Identifier: MIT
// Plain C++ with oneTBB: tbb::parallel_sort of all items by their cell, then bounds and one read.

#include <tbb/global_control.h>
#include <tbb/parallel_sort.h>

#include "peers/peer.hpp"

namespace bench {

using namespace peers;

void add_peer_parallel_sort(Suite& suite) {
    add_sort_path(suite, "parallel_sort", [&suite](const Workload& workload) {
        auto input = items_of(workload);
        auto items = uninitialized<Item>(workload.nodes);
        auto threads = std::make_unique<tbb::global_control>(
            tbb::global_control::max_allowed_parallelism, suite.threads());
        return [&suite, workload, input = std::move(input), items = std::move(items),
                threads = std::move(threads), offsets = std::vector<cl_uint>(workload.cells() + 1)](
                   std::vector<cl_uint>& digests) mutable {
            std::copy(&input[0], &input[workload.nodes], &items[0]);
            const auto begin = std::chrono::steady_clock::now();
            tbb::parallel_sort(&items[0], &items[workload.nodes],
                               [](const Item& a, const Item& b) { return a.cell < b.cell; });
            find_bounds(&items[0], workload.nodes, offsets, suite.threads());
            const double build = seconds_since(begin);
            read(&items[0], offsets, digests, suite.threads());
            return std::pair(build, seconds_since(begin) - build);
        };
    });
}

}  // namespace bench
