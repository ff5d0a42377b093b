// SPDX-License-Identifier: MIT
// The insert alone: device time for the runs of the user's kernel in a build. Storage::counted has
// two runs. It has one if the library moves the records afterwards, which does not count. Runs of
// the ceiling and of the insert are interleaved, so that other work on the machine does not change
// their ratio.

#include <numeric>

#include "ceiling.hpp"
#include "support/containers.hpp"
#include "support/moved_bytes.hpp"

namespace bench {

void add_insert(Suite& suite) {
    const auto measure = []<class Record>(const Suite& s, const Workload& workload,
                                          const Configuration& configuration) -> Result {
        Containers<Record> containers(s, workload, configuration);
        Ceilings ceilings(s, workload);
        std::size_t kernel_runs = 0;
        const std::vector<Samples> samples = sample(s.sampling(), [&]() -> std::vector<double> {
            const double ceiling = ceilings.exchange_and_store();
            const double allocating = ceilings.allocate_exchange_and_store();
            const std::vector<double> passes = containers.insert_seconds(containers.next());
            kernel_runs = passes.size();
            return {std::accumulate(passes.begin(), passes.end(), 0.0), ceiling, allocating};
        });
        return {samples[0],
                double(workload.nodes),
                insert_bytes(workload, configuration, kernel_runs),
                {{"ceiling_ms", 1e3 * samples[1].median},
                 {"of_ceiling", samples[1].median / samples[0].median},
                 {"allocating_ceiling_ms", 1e3 * samples[2].median},
                 {"of_allocating_ceiling", samples[2].median / samples[0].median}}};
    };
    add_cases(suite, "insert", suite.workloads(), storages(), measure);
    add_cases(suite, "insert", suite.bases(), allocations(), measure);
}

}  // namespace bench
