// SPDX-License-Identifier: MIT
#pragma once

// Shared by the peers in plain C++. Each peer puts the records of a workload into contiguous lists,
// one for each cell, and reads each list once.

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <new>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#if __has_include(<sys/mman.h>)
#include <sys/mman.h>
#endif

#include "support/oracle.hpp"
#include "support/records.hpp"
#include "support/suite.hpp"

namespace bench::peers {

/// A record with its cell, for sorts that keep them together.
struct Item {
    cl_uint cell;
    Record12 record;
};

struct Free {
    void operator()(void* memory) const { std::free(memory); }
};
template <class T>
using Array = std::unique_ptr<T[], Free>;

/// `size` elements without a value, in huge pages if the system has them. Scattered stores to small
/// pages spend much of their time on address translation.
template <class T>
Array<T> uninitialized(std::size_t size) {
    constexpr std::size_t page_bytes = 2 << 20;
    const std::size_t bytes = (size * sizeof(T) / page_bytes + 1) * page_bytes;
    void* memory = std::aligned_alloc(page_bytes, bytes);
    if (memory == nullptr) throw std::bad_alloc();
#ifdef MADV_HUGEPAGE
    madvise(memory, bytes, MADV_HUGEPAGE);
#endif
    return Array<T>(static_cast<T*>(memory));
}

/// The records of cell c are records[offsets[c]] ... records[offsets[c + 1] - 1].
struct Lists {
    explicit Lists(const Workload& workload)
        : offsets(workload.cells() + 1), records(uninitialized<Record12>(workload.nodes)) {}

    std::vector<cl_uint> offsets;
    Array<Record12> records;
};

/// Calls work(part, begin, end) for equal parts of 0 ... size - 1, each on its own thread.
template <class Work>
void in_parallel(unsigned threads, std::uint64_t size, const Work& work) {
    std::vector<std::jthread> others;
    for (unsigned part = 1; part < threads; ++part)
        others.emplace_back(
            [&, part] { work(part, size * part / threads, size * (part + 1) / threads); });
    work(0u, std::uint64_t{0}, size / threads);
}

/// Reads every list once.
inline void read(const Lists& lists, std::vector<cl_uint>& digests, unsigned threads) {
    in_parallel(threads, digests.size(), [&](unsigned, std::uint64_t begin, std::uint64_t end) {
        for (std::uint64_t cell = begin; cell < end; ++cell) {
            cl_uint digest = 0;
            for (cl_uint i = lists.offsets[cell]; i < lists.offsets[cell + 1]; ++i)
                digest += digest_of(lists.records[i]);
            digests[cell] = digest;
        }
    });
}

/// The same for items that are sorted by cell. They need no copy.
inline void read(const Item* items, const std::vector<cl_uint>& offsets,
                 std::vector<cl_uint>& digests, unsigned threads) {
    in_parallel(threads, digests.size(), [&](unsigned, std::uint64_t begin, std::uint64_t end) {
        for (std::uint64_t cell = begin; cell < end; ++cell) {
            cl_uint digest = 0;
            for (cl_uint i = offsets[cell]; i < offsets[cell + 1]; ++i)
                digest += digest_of(items[i].record);
            digests[cell] = digest;
        }
    });
}

/// Finds where each cell's items begin in sorted items; offsets has cells + 1 elements.
inline void find_bounds(const Item* items, std::size_t size, std::vector<cl_uint>& offsets,
                        unsigned threads) {
    in_parallel(threads, size + 1, [&](unsigned, std::uint64_t begin, std::uint64_t end) {
        for (std::uint64_t i = begin; i < end; ++i) {
            const std::size_t first = i == 0 ? 0 : std::size_t{items[i - 1].cell} + 1;
            const std::size_t last = i == size ? offsets.size() - 1 : items[i].cell;
            for (std::size_t cell = first; cell <= last; ++cell)
                offsets[cell] = static_cast<cl_uint>(i);
        }
    });
}

inline double seconds_since(std::chrono::steady_clock::time_point begin) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// The items of a workload, in the order of insertion.
Array<Item> items_of(const Workload& workload);

/// Adds a case "sort_path/peer:<name>/..." for each peer workload for which the machine has room.
/// `prepare(workload)` returns a function. That function makes the lists, reads them into the
/// digests of its argument, and returns the seconds of both.
template <class Prepare>
void add_sort_path(Suite& suite, const std::string& name, const Prepare& prepare) {
    for (const Workload& workload : suite.readable_bases()) {
        // Input, items, lists and a reserve.
        const double items_bytes = double(workload.nodes) * sizeof(Item);
        if (!fits(suite.device().info(), items_bytes, 4 * items_bytes)) continue;
        suite.add("sort_path/peer:" + name + "/" + workload.name(), [=, &suite]() -> Result {
            auto run = prepare(workload);
            std::vector<cl_uint> digests(workload.cells());
            run(digests);
            check_digests(digests, expected(workload).digests);
            return build_and_read(suite.sampling(), workload.nodes, [&] { return run(digests); });
        });
    }
}

}  // namespace bench::peers
