// SPDX-License-Identifier: MIT
// Whole builds, from the call to the report: clearing, the runs of the user's kernel, and the other
// work of the storage. Host time, with launches.

#include <chrono>

#include "support/containers.hpp"
#include "support/moved_bytes.hpp"

namespace bench {

namespace {

/// build() with all defaults: 4,096 records into 64 x 64 cells, on the default device.
Result small_build(const Suite& suite) {
    constexpr cl_uint nodes = 4096;
    const Workload workload{.occupancy = 1, .nodes = nodes};
    const cellist::Device device = cellist::Device::choose();
    cellist::Lists<Record12> lists(device, {64, 64});
    cellist::Kernel insert(device, source_of<Record12>(kernels::insert_cl, "insert.cl"), "insert",
                           lists);
    const auto build = [&] { lists.build(insert, nodes, workload.distribution.id, nodes); };
    build();
    cellist::Kernel read(device, source_of<Record12>(kernels::read_cl, "read.cl"), "read", lists);
    cellist::Buffer<cl_uint> digests(device, workload.cells());
    read.run(workload.cells(), lists, digests);
    check_digests(digests.download(), expected(workload).digests);

    Sampling sampling = suite.sampling();
    sampling.most *= 10;
    // build() blocks until the device has counted the records, so there is nothing to wait for.
    const Samples samples = sample(sampling, [&] {
        const auto begin = std::chrono::steady_clock::now();
        build();
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    });
    return {samples, nodes, 0};
}

}  // namespace

void add_build(Suite& suite) {
    add_cases(suite, "build", suite.workloads(), storages(),
              []<class Record>(const Suite& s, const Workload& workload,
                               const Configuration& configuration) {
                  Containers<Record> containers(s, workload, configuration);
                  const std::size_t kernel_runs = containers.build(containers.next()).passes;
                  const Samples samples = sample(s.sampling(), [&] {
                      cellist::Lists<Record>& lists = containers.next();
                      return host_seconds(s.device(), [&] { containers.build(lists); });
                  });
                  return Result{samples, double(workload.nodes),
                                build_bytes(workload, configuration, kernel_runs)};
              });
    suite.add("small_build", [&suite] { return small_build(suite); });
}

}  // namespace bench
