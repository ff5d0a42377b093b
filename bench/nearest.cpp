// SPDX-License-Identifier: MIT
// The 8 nearest records of every cell, in device time.

#include "support/containers.hpp"
#include "support/moved_bytes.hpp"

namespace bench {

void add_nearest(Suite& suite) {
    add_cases(
        suite, "nearest", random_and_coherent(suite.bases(BENCH_READABLE_NODES)), storages(),
        []<class Record>(const Suite& s, const Workload& workload,
                         const Configuration& configuration) {
            constexpr cl_uint k = 8;
            Containers<Record> containers(s, workload, configuration);
            cellist::Source source = source_of<Record>(kernels::nearest_cl, "nearest.cl");
            source.options += " -DBENCH_NEAREST=" + std::to_string(k);
            cellist::Kernel nearest(s.device(), source, "nearest", containers.next());
            cellist::Buffer<cl_uint> digests(s.device(), workload.cells());
            nearest.run(workload.cells(), containers.next(), digests);
            check_digests(digests.download(), expected_nearest(workload, k));
            const Samples samples = sample(s.sampling(), [&] {
                return device_seconds(nearest.run(workload.cells(), containers.next(), digests));
            });
            return Result{samples, double(workload.nodes), read_bytes(workload, configuration)};
        });
}

}  // namespace bench
