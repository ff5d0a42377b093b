// SPDX-License-Identifier: MIT
#include "support/oracle.hpp"

#include <algorithm>
#include <atomic>
#include <map>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>

#include "support/records.hpp"

namespace bench {

namespace {

cl_uint digest_of(const Workload& workload, cl_uint i) {
    cl_uint digest = 0;
    for (cl_uint j = 0; j < workload.words(); ++j) digest += bench_digest_word(bench_word(i, j), j);
    return digest;
}

/// Calls work(i) for 0 ... size - 1, from all cores.
template <class Work>
void in_parallel(cl_uint size, const Work& work) {
    const cl_uint parts = std::max(1u, std::thread::hardware_concurrency());
    std::vector<std::jthread> threads;
    for (cl_uint part = 0; part < parts; ++part)
        threads.emplace_back([&, part] {
            const auto begin = static_cast<cl_uint>(std::uint64_t{size} * part / parts);
            const auto end = static_cast<cl_uint>(std::uint64_t{size} * (part + 1) / parts);
            for (cl_uint i = begin; i < end; ++i) work(i);
        });
}

/// Calls work(i, cell) for all nodes of a workload, from all cores.
template <class Work>
void for_all_nodes(const Workload& workload, const Work& work) {
    const cl_uint cells = workload.cells();
    in_parallel(workload.nodes,
                [&](cl_uint i) { work(i, bench_cell(i, cells, workload.distribution.id)); });
}

cl_uint add(cl_uint& sum, cl_uint value) {
    return std::atomic_ref(sum).fetch_add(value, std::memory_order_relaxed);
}

}  // namespace

const Expected& expected(const Workload& workload) {
    static std::map<std::string, Expected> known;
    const auto [at, is_new] = known.try_emplace(workload.name());
    if (!is_new) return at->second;
    std::vector<cl_uint> counts(workload.cells());
    std::vector<cl_uint> digests(workload.cells());
    for_all_nodes(workload, [&](cl_uint i, cl_uint cell) {
        add(counts[cell], 1);
        add(digests[cell], digest_of(workload, i));
    });
    at->second = {std::move(digests), *std::max_element(counts.begin(), counts.end())};
    return at->second;
}

const std::vector<cl_uint>& expected_nearest(const Workload& workload, cl_uint k) {
    static std::map<std::string, std::vector<cl_uint>> known;
    const auto [known_at, is_new] = known.try_emplace(std::to_string(k) + "/" + workload.name());
    if (!is_new) return known_at->second;

    // The indices of each cell's records, cell by cell.
    std::vector<cl_uint> ends(workload.cells() + 1);
    for_all_nodes(workload, [&](cl_uint, cl_uint cell) { add(ends[cell + 1], 1); });
    for (std::size_t cell = 1; cell < ends.size(); ++cell) ends[cell] += ends[cell - 1];
    std::vector<cl_uint> indices(workload.nodes);
    std::vector<cl_uint> at(ends.begin(), ends.end() - 1);
    for_all_nodes(workload, [&](cl_uint i, cl_uint cell) { indices[add(at[cell], 1)] = i; });

    std::vector<cl_uint>& digests = known_at->second;
    digests.resize(workload.cells());
    in_parallel(workload.cells(), [&](cl_uint cell) {
        const auto begin = indices.begin() + ends[cell];
        const auto end = indices.begin() + ends[cell + 1];
        const auto nearest = end - begin > k ? begin + k : end;
        std::partial_sort(begin, nearest, end, [](cl_uint a, cl_uint b) {
            return bench_word(a, 0) < bench_word(b, 0);  // keys are all different
        });
        for (auto i = begin; i != nearest; ++i) digests[cell] += digest_of(workload, *i);
    });
    return digests;
}

void check_digests(const std::vector<cl_uint>& digests, const std::vector<cl_uint>& expected) {
    if (digests.size() != expected.size())
        throw std::runtime_error("there are " + std::to_string(digests.size()) + " lists, not " +
                                 std::to_string(expected.size()));
    const auto [wrong, right] = std::mismatch(digests.begin(), digests.end(), expected.begin());
    if (wrong != digests.end())
        throw std::runtime_error("the list of cell " + std::to_string(wrong - digests.begin()) +
                                 " is wrong");
}

}  // namespace bench
