// SPDX-License-Identifier: MIT
// Boost.Compute on the same device: sort_by_key of the records by their cell, then bounds and one
// read. Values are the records, padded to 16 bytes, or indices through which the records are read.
// Host time; the input is in memory. Each run reads once more, to time the read alone.

#define CL_TARGET_OPENCL_VERSION 300
#include <boost/compute/algorithm/sort_by_key.hpp>
#include <boost/compute/buffer.hpp>
#include <boost/compute/command_queue.hpp>
#include <boost/compute/iterator/buffer_iterator.hpp>
#include <boost/compute/types/fundamental.hpp>

#include "support/containers.hpp"

namespace bench {

namespace {

namespace compute = boost::compute;

class BoostCompute {
public:
    BoostCompute(const Suite& suite, const Workload& workload)
        : workload_(workload),
          device_(suite.device()),
          queue_(suite.device().queue()()),
          find_bounds_(kernel("find_bounds")),
          input_cells_(device_, workload.nodes),
          cells_(device_, workload.nodes),
          offsets_(device_, workload.cells() + 1),
          digests_(device_, workload.cells()) {}

    /// Sorts the records themselves.
    Result with_values(const Sampling& sampling) {
        cellist::Buffer<cl_uint4> input(device_, workload_.nodes);
        cellist::Buffer<cl_uint4> values(device_, workload_.nodes);
        kernel("store_values")
            .run(workload_.nodes, input_cells_, input, workload_.cells(),
                 workload_.distribution.id);
        cellist::Kernel read = kernel("read_values");
        return measure(
            sampling, [&] { copy(input, values); },
            [&] {
                compute::sort_by_key(begin<cl_uint>(cells_), end<cl_uint>(cells_),
                                     begin<compute::uint4_>(values), queue_);
                find_bounds();
            },
            [&] { read.run(workload_.cells(), offsets_, values, digests_); });
    }

    /// Sorts their indices.
    Result with_indices(const Sampling& sampling) {
        cellist::Buffer<cl_uint> input(device_, workload_.nodes);
        cellist::Buffer<cl_uint> indices(device_, workload_.nodes);
        cellist::Buffer<Record12> records(device_, workload_.nodes);
        kernel("store_indices")
            .run(workload_.nodes, input_cells_, input, records, workload_.cells(),
                 workload_.distribution.id);
        cellist::Kernel read = kernel("read_indexed");
        return measure(
            sampling, [&] { copy(input, indices); },
            [&] {
                compute::sort_by_key(begin<cl_uint>(cells_), end<cl_uint>(cells_),
                                     begin<cl_uint>(indices), queue_);
                find_bounds();
            },
            [&] { read.run(workload_.cells(), offsets_, indices, records, digests_); });
    }

private:
    template <class As, class T>
    static compute::buffer_iterator<As> begin(const cellist::Buffer<T>& buffer) {
        return compute::make_buffer_iterator<As>(compute::buffer(buffer.cl()()), 0);
    }
    template <class As, class T>
    static compute::buffer_iterator<As> end(const cellist::Buffer<T>& buffer) {
        return begin<As>(buffer) + static_cast<std::ptrdiff_t>(buffer.size());
    }

    [[nodiscard]] cellist::Kernel kernel(const std::string& name) const {
        return {device_, source_of<Record12>(kernels::boost_compute_cl, "boost_compute.cl"), name,
                cellist::type<Record12>};
    }

    template <class T>
    void copy(const cellist::Buffer<T>& from, const cellist::Buffer<T>& to) {
        device_.queue().enqueueCopyBuffer(from.cl(), to.cl(), 0, 0, from.size() * sizeof(T));
    }

    void find_bounds() {
        find_bounds_.run(cellist::Range::padded(workload_.nodes + 1), cells_, workload_.nodes,
                         workload_.cells(), offsets_);
    }

    Result measure(const Sampling& sampling, const std::function<void()>& prepare,
                   const std::function<void()>& build, const std::function<void()>& read) {
        const auto run = [&] {
            copy(input_cells_, cells_);
            prepare();
            const double both = host_seconds(device_, [&] {
                build();
                read();
            });
            const double read_alone = host_seconds(device_, read);
            return std::pair(both - read_alone, read_alone);
        };
        run();
        check_digests(digests_.download(), expected(workload_).digests);
        return build_and_read(sampling, workload_.nodes, run);
    }

    Workload workload_;
    const cellist::Device& device_;
    compute::command_queue queue_;
    cellist::Kernel find_bounds_;
    cellist::Buffer<cl_uint> input_cells_;
    cellist::Buffer<cl_uint> cells_;
    cellist::Buffer<cl_uint> offsets_;
    cellist::Buffer<cl_uint> digests_;
};

}  // namespace

void add_peer_boost_compute(Suite& suite) {
    for (const Workload& workload : suite.sorted_workloads()) {
        // Two arrays of cells and two of values, and the memory of the sort.
        const double values_bytes = double(workload.nodes) * sizeof(cl_uint4);
        if (!fits(suite.device().info(), values_bytes, 5 * values_bytes)) continue;
        suite.add("sort_path/peer:boost_compute/" + workload.name(), [&suite, workload] {
            return BoostCompute(suite, workload).with_values(suite.sampling());
        });
        suite.add("sort_path/peer:boost_compute_index/" + workload.name(), [&suite, workload] {
            return BoostCompute(suite, workload).with_indices(suite.sampling());
        });
    }
}

}  // namespace bench
