// SPDX-License-Identifier: MIT
// Packs all lists into a contiguous copy, in host time. Each run allocates the buffers.

#include "support/containers.hpp"
#include "support/moved_bytes.hpp"

namespace bench {

void add_pack(Suite& suite) {
    add_cases(
        suite, "pack", random_and_coherent(suite.bases(BENCH_READABLE_NODES)), storages(),
        []<class Record>(const Suite& s, const Workload& workload,
                         const Configuration& configuration) {
            Containers<Record> containers(s, workload, configuration);
            cellist::Kernel read(s.device(), source_of<Record>(kernels::read_cl, "read.cl"),
                                 "read_packed", containers.next());
            cellist::Buffer<cl_uint> digests(s.device(), workload.cells());
            {
                const cellist::Packed<Record> packed = containers.next().pack();
                read.run(workload.cells(), packed.offsets, packed.records, digests);
            }
            check_digests(digests.download(), expected(workload).digests);
            const Samples samples = sample(s.sampling(), [&] {
                const cellist::Lists<Record>& lists = containers.next();
                return host_seconds(s.device(), [&] { (void)lists.pack(); });
            });
            return Result{samples, double(workload.nodes), pack_bytes(workload, configuration)};
        });
}

}  // namespace bench
