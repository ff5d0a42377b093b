// SPDX-License-Identifier: MIT
#include "peers/peer.hpp"

namespace bench::peers {

Array<Item> items_of(const Workload& workload) {
    Array<Item> items = uninitialized<Item>(workload.nodes);
    in_parallel(std::max(1u, std::thread::hardware_concurrency()), workload.nodes,
                [&](unsigned, std::uint64_t begin, std::uint64_t end) {
                    for (std::uint64_t at = begin; at < end; ++at) {
                        const auto i = static_cast<cl_uint>(at);
                        items[i] = {bench_cell(i, workload.cells(), workload.distribution.id),
                                    record_of<Record12>(i)};
                    }
                });
    return items;
}

}  // namespace bench::peers
