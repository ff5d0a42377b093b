// SPDX-License-Identifier: MIT
// Sorts lists whose records share keys, four to a key, and the same lists with unique keys, in host
// time. The counter unique_ms is the time of the second sort.

#include "support/containers.hpp"
#include "support/moved_bytes.hpp"

namespace bench {

namespace {

void add_ties(Suite& suite, const std::string& name, const auto& sort) {
    std::vector<Workload> workloads;
    for (const cl_uint length : {16u, 64u, 1024u}) {
        workloads.push_back(suite.base(coherent));
        workloads.back().occupancy = length;
    }
    std::vector<Configuration> configurations = storages();
    configurations.resize(2);  // fixed lists are sorted as counted ones
    add_cases(suite, name, workloads, configurations,
              [sort]<class Record>(const Suite& s, const Workload& workload,
                                   const Configuration& configuration) {
                  Containers<Record> containers(s, workload, configuration);
                  cellist::Lists<Record>& any = containers.next();
                  cellist::Kernel tie(s.device(), source_of<Record>(kernels::sort_cl, "sort.cl"),
                                      "tie_keys", any);
                  const auto seconds = [&](bool tied) {
                      cellist::Lists<Record>& lists = containers.next();
                      containers.build(lists);
                      if (tied) tie.run(workload.cells(), lists, workload.occupancy / 4);
                      return host_seconds(s.device(), [&] { sort(lists); });
                  };
                  for (std::size_t i = 0; i < containers.size(); ++i) sort(containers.next());
                  const std::vector<Samples> samples = sample(s.sampling(), [&] {
                      return std::vector{seconds(true), seconds(false)};
                  });
                  return Result{samples[0],
                                double(workload.nodes),
                                sort_bytes(workload),
                                {{"unique_ms", 1e3 * samples[1].median}}};
              });
}

}  // namespace

void add_sort_ties(Suite& suite) {
    add_ties(suite, "sort_ties_by_member",
             []<class Record>(cellist::Lists<Record>& lists) { lists.sort(&Record::key); });
    add_ties(suite, "sort_ties_by_expression", [](auto& lists) {
        lists.sort_by("record.key ^ mask", {{"mask", cl_uint{5}}});
    });
}

}  // namespace bench
