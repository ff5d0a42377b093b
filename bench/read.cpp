// SPDX-License-Identifier: MIT
// Traverses every list once, in device time.

#include "support/containers.hpp"
#include "support/moved_bytes.hpp"

namespace bench {

namespace {

template <class Record>
Result read(const Suite& suite, const Workload& workload, const Configuration& configuration) {
    Containers<Record> containers(suite, workload, configuration);
    cellist::Buffer<cl_uint> digests(suite.device(), workload.cells());
    cellist::Kernel read(suite.device(), source_of<Record>(kernels::read_cl, "read.cl"), "read",
                         containers.next());
    const Samples samples = sample(suite.sampling(), [&] {
        return device_seconds(read.run(workload.cells(), containers.next(), digests));
    });
    return {samples, double(workload.nodes), read_bytes(workload, configuration)};
}

}  // namespace

void add_read(Suite& suite) {
    add_cases(suite, "read", suite.bases(BENCH_READABLE_NODES), storages(),
              []<class Record>(const Suite& s, const Workload& workload,
                               const Configuration& configuration) {
                  return read<Record>(s, workload, configuration);
              });
}

}  // namespace bench
