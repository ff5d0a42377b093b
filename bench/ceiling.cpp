// SPDX-License-Identifier: MIT
#include "ceiling.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "bench_kernels.hpp"
#include "support/containers.hpp"

namespace bench {

namespace {

cellist::Source ceiling_source(const Workload& workload) {
    return {.text = std::string(kernels::distribution_h) + std::string(kernels::ceiling_cl),
            .file_name = "ceiling.cl",
            .options = "-DBENCH_WORDS=" + std::to_string(workload.words())};
}

}  // namespace

Ceilings::Ceilings(const Suite& suite, const Workload& workload)
    : workload_(workload),
      source_(ceiling_source(workload)),
      copy_(suite.device(), source_, "copy"),
      store_(suite.device(), source_, "store"),
      exchange_(suite.device(), source_, "exchange"),
      exchange_and_store_(suite.device(), source_, "exchange_and_store"),
      allocate_exchange_and_store_(suite.device(), source_, "allocate_exchange_and_store"),
      counters_(suite.device(), 256 * 16) {
    const std::uint64_t words = std::uint64_t{workload.nodes} * (workload.words() + 1);
    const std::uint64_t bytes = (words + workload.cells()) * sizeof(cl_uint);
    // copy() needs two.
    const std::uint64_t copies = std::max<std::uint64_t>(suite.copies(bytes), 2);
    for (std::uint64_t i = 0; i < copies; ++i) {
        buffers_.push_back({{suite.device(), workload.cells()}, {suite.device(), words}});
        exchange_and_store();
    }
    if (workload.longest() <= BENCH_READABLE_NODES) check(suite.device());
}

Ceilings::Buffers& Ceilings::next() {
    turn_ = (turn_ + 1) % buffers_.size();
    buffers_[turn_].heads.fill(~cl_uint{0});
    return buffers_[turn_];
}

double Ceilings::copy() {
    const Buffers& from = next();
    return device_seconds(copy_.run(workload_.nodes, from.nodes, next().nodes, workload_.nodes));
}

double Ceilings::store() {
    return device_seconds(store_.run(workload_.nodes, next().nodes, workload_.cells(),
                                     workload_.distribution.id, workload_.nodes));
}

double Ceilings::exchange() {
    return device_seconds(exchange_.run(workload_.nodes, next().heads, workload_.cells(),
                                        workload_.distribution.id, workload_.nodes));
}

double Ceilings::exchange_and_store() {
    Buffers& buffers = next();
    return device_seconds(exchange_and_store_.run(workload_.nodes, buffers.heads, buffers.nodes,
                                                  workload_.cells(), workload_.distribution.id,
                                                  workload_.nodes));
}

double Ceilings::allocate_exchange_and_store() {
    Buffers& buffers = next();
    counters_.fill(0);
    return device_seconds(allocate_exchange_and_store_.run(
        cellist::Range::padded(workload_.nodes), buffers.heads, buffers.nodes, counters_,
        workload_.cells(), workload_.distribution.id, workload_.nodes));
}

void Ceilings::check(const cellist::Device& device) {
    cellist::Kernel read(device, source_, "read_nodes");
    cellist::Buffer<cl_uint> digests(device, workload_.cells());
    exchange_and_store();
    read.run(workload_.cells(), buffers_[turn_].heads, buffers_[turn_].nodes, digests);
    check_digests(digests.download(), expected(workload_).digests);
}

void add_ceilings(Suite& suite) {
    struct Operation {
        const char* name;
        double (Ceilings::*run)();
        double head_bytes, node_copies;  ///< that are moved for each node
    };
    for (const Operation& operation :
         {Operation{"copy", &Ceilings::copy, 0, 2}, Operation{"store", &Ceilings::store, 0, 1},
          Operation{"exchange", &Ceilings::exchange, 8, 0},
          Operation{"exchange_and_store", &Ceilings::exchange_and_store, 8, 1},
          Operation{"allocate_exchange_and_store", &Ceilings::allocate_exchange_and_store, 8, 1}}) {
        for (const Workload& workload : suite.workloads()) {
            // Every size of random cells, and the base of the others.
            if (workload.distribution.id != BENCH_RANDOM &&
                workload.name() != suite.base(workload.distribution).name())
                continue;
            if (!fits(suite.device().info(), workload, storages().front())) continue;
            suite.add(std::string("ceiling/operation:") + operation.name + "/" + workload.name(),
                      [=, &suite]() -> Result {
                          Ceilings ceilings(suite, workload);
                          const Samples samples =
                              sample(suite.sampling(), [&] { return (ceilings.*operation.run)(); });
                          const double bytes =
                              operation.head_bytes + operation.node_copies * workload.node_bytes;
                          return {samples, double(workload.nodes), bytes * workload.nodes};
                      });
        }
    }
}

}  // namespace bench
