// SPDX-License-Identifier: MIT
// Sorts every list by its key, in host time. Each run builds the lists again, so that none is
// already sorted.

#include "support/containers.hpp"
#include "support/moved_bytes.hpp"

namespace bench {

namespace {

/// Longest list that is sorted in a benchmark.
constexpr double sortable_nodes = 1 << 12;

template <class Record>
void check_sorted(const Suite& suite, const Workload& workload, cellist::Lists<Record>& lists) {
    cellist::Buffer<cl_uint> unsorted(suite.device(), 1);
    unsorted.fill(0);
    cellist::Kernel count(suite.device(), source_of<Record>(kernels::sort_cl, "sort.cl"),
                          "count_unsorted", lists);
    count.run(workload.cells(), lists, unsorted);
    if (const cl_uint found = unsorted.download().front(); found != 0)
        throw std::runtime_error(std::to_string(found) + " nodes are out of order");
    cellist::Buffer<cl_uint> digests(suite.device(), workload.cells());
    cellist::Kernel read(suite.device(), source_of<Record>(kernels::read_cl, "read.cl"), "read",
                         lists);
    read.run(workload.cells(), lists, digests);
    check_digests(digests.download(), expected(workload).digests);
}

}  // namespace

void add_sort(Suite& suite) {
    // Lists of one length each, beside the other workloads.
    std::vector<Workload> workloads = suite.bases(sortable_nodes);
    for (const cl_uint length : {8u, 16u, 32u, 64u, 1024u}) {
        workloads.push_back(suite.base(coherent));
        workloads.back().occupancy = length;
    }
    add_cases(suite, "sort", workloads, storages(),
              []<class Record>(const Suite& s, const Workload& workload,
                               const Configuration& configuration) {
                  Containers<Record> containers(s, workload, configuration);
                  cellist::Lists<Record>& first = containers.next();
                  first.sort(&Record::key);
                  check_sorted(s, workload, first);
                  for (std::size_t i = 1; i < containers.size(); ++i)
                      containers.next().sort(&Record::key);
                  const Samples samples = sample(s.sampling(), [&] {
                      cellist::Lists<Record>& lists = containers.next();
                      containers.build(lists);
                      return host_seconds(s.device(), [&] { lists.sort(&Record::key); });
                  });
                  return Result{samples, double(workload.nodes), sort_bytes(workload)};
              });
}

}  // namespace bench
