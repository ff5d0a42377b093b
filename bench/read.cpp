// Walking every list once, on its own and behind a build.

#include "support/containers.hpp"

namespace bench {

namespace {

/// Bytes that reading moves at least: the records, with their links where there are some, the heads or
/// offsets, and a digest for each cell.
double read_bytes(const Workload& workload, const Keeping& keeping) {
    const bool linked = keeping.options.storage == cellist::Storage::linked;
    return double(workload.nodes) * (linked ? workload.node_bytes : 4 * workload.words()) +
           8.0 * workload.cells();
}

template <class Record>
Result read(const Suite& suite, const Workload& workload, const Keeping& keeping) {
    Containers<Record> containers(suite, workload, keeping);
    cellist::Buffer<cl_uint> digests(suite.device(), workload.cells());
    cellist::Kernel read(suite.device(), source_of<Record>(kernels::read_cl, "read.cl"), "read",
                         containers.next());
    const Samples samples = sample(suite.sampling(), [&] {
        return device_seconds(read.run(workload.cells(), containers.next(), digests));
    });
    return {samples, double(workload.nodes), read_bytes(workload, keeping)};
}

/// A build and one read, in host time: what a user waits for.
template <class Record>
Result build_read(const Suite& suite, const Workload& workload, const Keeping& keeping,
                  Input input) {
    Containers<Record> containers(suite, workload, keeping, input);
    cellist::Buffer<cl_uint> digests(suite.device(), workload.cells());
    cellist::Kernel read(suite.device(), source_of<Record>(kernels::read_cl, "read.cl"), "read",
                         containers.next());
    const std::vector<Samples> samples = sample(suite.sampling(), [&]() -> std::vector<double> {
        cellist::Lists<Record>& lists = containers.next();
        const double build = host_seconds(suite.device(), [&] { containers.build(lists); });
        const double reading =
            host_seconds(suite.device(), [&] { read.run(workload.cells(), lists, digests); });
        return {build + reading, build, reading};
    });
    return {samples[0],
            double(workload.nodes),
            0,
            {{"build_ms", 1e3 * samples[1].median}, {"read_ms", 1e3 * samples[2].median}}};
}

/// The workloads that storages are compared on: 5 distributions by 5 occupancies, a quarter of the
/// usual size, or so small that every list can be read by one work-item.
std::vector<Workload> storage_grid(const Suite& suite) {
    std::vector<cl_uint> occupancies{1, 4, 16, 64, 256};
    if (suite.effort() == Effort::tiny) occupancies = {4};
    std::vector<Workload> grid;
    for (const Distribution& distribution : distributions) {
        for (const cl_uint occupancy : occupancies) {
            Workload workload = suite.base(distribution);
            workload.occupancy = occupancy;
            workload.nodes /= 4;
            while (workload.longest() > readable_nodes) workload.nodes /= 2;
            grid.push_back(workload);
        }
    }
    return grid;
}

}  // namespace

void add_read(Suite& suite) {
    add_cases(suite, "read", suite.workloads(readable_nodes), storages(),
              []<class Record>(const Suite& s, const Workload& workload, const Keeping& keeping) {
                  return read<Record>(s, workload, keeping);
              });

    const std::vector<Workload> bases{suite.base(random), suite.base(coherent), suite.base(runs)};
    add_cases(suite, "build_read/input:generated", bases, storages(),
              []<class Record>(const Suite& s, const Workload& workload, const Keeping& keeping) {
                  return build_read<Record>(s, workload, keeping, Input::generated);
              });
    add_cases(suite, "build_read/input:stored", bases, storages(),
              []<class Record>(const Suite& s, const Workload& workload, const Keeping& keeping) {
                  return build_read<Record>(s, workload, keeping, Input::stored);
              });

    std::vector<Keeping> keepings = storages();
    keepings.insert(keepings.end(), automatic_storages().begin(), automatic_storages().end());
    add_cases(suite, "build_read/input:generated", storage_grid(suite), keepings,
              []<class Record>(const Suite& s, const Workload& workload, const Keeping& keeping) {
                  return build_read<Record>(s, workload, keeping, Input::generated);
              });
}

}  // namespace bench
