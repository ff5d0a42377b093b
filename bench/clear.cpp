// SPDX-License-Identifier: MIT
// Clears all lists, in host time. The items are cells.

#include "support/containers.hpp"

namespace bench {

void add_clear(Suite& suite) {
    add_cases(suite, "clear", {suite.base(random)}, storages(),
              []<class Record>(const Suite& s, const Workload& workload,
                               const Configuration& configuration) {
                  Containers<Record> containers(s, workload, configuration);
                  cellist::Lists<Record>& first = containers.next();
                  first.clear();
                  if (first.lengths().total != 0)
                      throw std::runtime_error("the lists are not empty");
                  const Samples samples = sample(s.sampling(), [&] {
                      cellist::Lists<Record>& lists = containers.next();
                      return host_seconds(s.device(), [&] { lists.clear(); });
                  });
                  return Result{samples, double(workload.cells()), 4.0 * workload.cells()};
              });
}

}  // namespace bench
