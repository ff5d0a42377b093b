// SPDX-License-Identifier: MIT
// Plain C++: std::sort. One case sorts all items by their cell on one thread, with bounds and one
// read. The other sorts every list separately, on all threads.

#include "peers/peer.hpp"

namespace bench {

using namespace peers;

namespace {

/// Sorts lists of one length by key.
Result sort_lists(const Suite& suite, const Workload& workload) {
    const cl_uint length = workload.nodes / workload.cells();
    // Contiguous lists, in the order of insertion, and a copy to sort.
    const Array<Record12> unsorted = uninitialized<Record12>(workload.nodes);
    for (cl_uint cell = 0; cell < workload.cells(); ++cell)
        for (cl_uint i = 0; i < length; ++i)
            unsorted[cell * length + i] = record_of<Record12>(cell + i * workload.cells());
    const Array<Record12> records = uninitialized<Record12>(workload.nodes);
    const auto by_key = [](const Record12& a, const Record12& b) { return a.key < b.key; };

    const auto run = [&] {
        in_parallel(suite.threads(), workload.nodes,
                    [&](unsigned, std::uint64_t begin, std::uint64_t end) {
                        std::copy(&unsorted[begin], &unsorted[end], &records[begin]);
                    });
        const auto begin = std::chrono::steady_clock::now();
        in_parallel(suite.threads(), workload.cells(),
                    [&](unsigned, std::uint64_t first, std::uint64_t last) {
                        for (std::uint64_t cell = first; cell < last; ++cell)
                            std::sort(&records[cell * length], &records[(cell + 1) * length],
                                      by_key);
                    });
        return seconds_since(begin);
    };
    run();
    for (cl_uint cell = 0; cell < workload.cells(); ++cell)
        if (!std::is_sorted(&records[cell * length], &records[(cell + 1) * length], by_key))
            throw std::runtime_error("a list is not sorted");
    return {sample(suite.sampling(), run), double(workload.nodes), 0};
}

}  // namespace

void add_peer_std_sort(Suite& suite) {
    add_sort_path(suite, "std_sort", [&suite](const Workload& workload) {
        auto input = items_of(workload);
        auto items = uninitialized<Item>(workload.nodes);
        return [&suite, workload, input = std::move(input), items = std::move(items),
                offsets = std::vector<cl_uint>(workload.cells() + 1)](
                   std::vector<cl_uint>& digests) mutable {
            std::copy(&input[0], &input[workload.nodes], &items[0]);
            const auto begin = std::chrono::steady_clock::now();
            std::sort(&items[0], &items[workload.nodes],
                      [](const Item& a, const Item& b) { return a.cell < b.cell; });
            find_bounds(&items[0], workload.nodes, offsets, suite.threads());
            const double build = seconds_since(begin);
            read(&items[0], offsets, digests, suite.threads());
            return std::pair(build, seconds_since(begin) - build);
        };
    });

    for (const cl_uint length : {8u, 16u, 32u, 64u}) {
        Workload workload = suite.base(coherent);
        workload.occupancy = length;
        suite.add("segmented_sort/peer:std_sort/" + workload.name(),
                  [&suite, workload] { return sort_lists(suite, workload); });
    }
}

}  // namespace bench
