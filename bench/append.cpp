// SPDX-License-Identifier: MIT
// Appends of 1 % more records, from the call to the report. Host time, with launches. The counter
// `of_build` is the time in parts of a build of all records in the same lists.

#include "support/containers.hpp"
#include "support/moved_bytes.hpp"

namespace bench {

void add_append(Suite& suite) {
    add_cases(suite, "append", suite.readable_bases(), storages(),
              []<class Record>(const Suite& s, const Workload& workload,
                               const Configuration& configuration) {
                  Containers<Record> containers(s, workload, configuration);
                  Workload added = workload;
                  added.nodes = std::max(workload.nodes / 100, 1u);
                  const auto append = [&](cellist::Lists<Record>& lists) {
                      const cellist::BuildReport report = containers.append(lists, added.nodes);
                      if (report.stored != std::uint64_t{workload.nodes} + added.nodes)
                          throw std::runtime_error("the append lost records");
                  };
                  // The pools grow once.
                  for (std::size_t i = 0; i < containers.size(); ++i) append(containers.next());
                  const std::vector<Samples> samples = sample(s.sampling(), [&] {
                      cellist::Lists<Record>& lists = containers.next();
                      const double build =
                          host_seconds(s.device(), [&] { containers.build(lists); });
                      return std::vector{host_seconds(s.device(), [&] { append(lists); }), build};
                  });
                  return Result{samples[0],
                                double(added.nodes),
                                insert_bytes(added, configuration, 1),
                                {{"of_build", samples[0].median / samples[1].median}}};
              });
}

}  // namespace bench
