// SPDX-License-Identifier: MIT
// Plain C++: two counting sorts on all threads.
//
//   direct        a histogram of the cells for each thread, prefix sums over cells and threads,
//                 and a scatter. Destinations are prefetched some records ahead.
//   partitioned   the records first go to partitions of cells that fit into a core's cache, in
//                 whole cache lines that bypass the cache. Each partition is then counted and
//                 scattered within the cache. After Polychroniou and Ross, "A Comprehensive Study
//                 of Main-Memory Partitioning", SIGMOD 2014.
//
// The input is in memory, or the loops compute it, as a kernel does.

#include <array>
#include <atomic>
#include <barrier>
#include <bit>
#include <cstring>

#include "peers/peer.hpp"

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace bench {

using namespace peers;

namespace {

/// Records that are computed on demand. The distribution is known at compile time.
template <cl_uint distribution>
struct Generated {
    cl_uint cells;
    [[nodiscard]] cl_uint cell(std::size_t i) const {
        return bench_cell(static_cast<cl_uint>(i), cells, distribution);
    }
    [[nodiscard]] Record12 record(std::size_t i) const {
        return record_of<Record12>(static_cast<cl_uint>(i));
    }
};

/// Records in memory. Cells have their own array, because the histogram needs only them.
struct Stored {
    explicit Stored(const Workload& workload)
        : cells(uninitialized<cl_uint>(workload.nodes)),
          records(uninitialized<Record12>(workload.nodes)) {
        const Array<Item> items = items_of(workload);
        for (std::size_t i = 0; i < workload.nodes; ++i) {
            cells[i] = items[i].cell;
            records[i] = items[i].record;
        }
    }
    [[nodiscard]] cl_uint cell(std::size_t i) const { return cells[i]; }
    [[nodiscard]] Record12 record(std::size_t i) const { return records[i]; }

    Array<cl_uint> cells;
    Array<Record12> records;
};

/// Numbers of each thread, in separate cache lines.
class Histograms {
public:
    Histograms(unsigned threads, std::size_t size)
        : stride_((size + 31) / 32 * 32), counts_(stride_ * threads) {}
    cl_uint* of(unsigned thread) { return &counts_[stride_ * thread]; }

private:
    std::size_t stride_;
    std::vector<cl_uint> counts_;
};

/// Turns each thread's counts of `size` bins into the offset of its first record in each bin. Bins
/// are in order, and so are threads within a bin. Every thread calls it, between its own barriers.
/// `offsets` gets the begin of each bin.
class PrefixSums {
public:
    PrefixSums(unsigned threads, std::size_t size)
        : threads_(threads), size_(size), sums_(threads) {}

    template <class Barrier>
    void run(unsigned thread, Histograms& histograms, cl_uint* offsets, Barrier& barrier) {
        const std::size_t begin = size_ * thread / threads_;
        const std::size_t end = size_ * (thread + 1) / threads_;
        cl_uint sum = 0;
        for (unsigned other = 0; other < threads_; ++other) {
            const cl_uint* counts = histograms.of(other);
            for (std::size_t bin = begin; bin < end; ++bin) sum += counts[bin];
        }
        sums_[thread].value = sum;
        barrier.arrive_and_wait();
        cl_uint at = 0;
        for (unsigned before = 0; before < thread; ++before) at += sums_[before].value;
        for (std::size_t bin = begin; bin < end; ++bin) {
            offsets[bin] = at;
            for (unsigned other = 0; other < threads_; ++other) {
                cl_uint& count = histograms.of(other)[bin];
                at += std::exchange(count, at);
            }
        }
        barrier.arrive_and_wait();
    }

private:
    struct alignas(64) Sum {
        cl_uint value;
    };
    unsigned threads_;
    std::size_t size_;
    std::vector<Sum> sums_;
};

inline void prefetch_for_write(const void* address) { __builtin_prefetch(address, 1); }

template <class Input>
class Direct {
public:
    Direct(const Workload& workload, unsigned threads, Input input)
        : workload_(workload),
          threads_(threads),
          input_(std::move(input)),
          counts_(threads, workload.cells()),
          prefix_sums_(threads, workload.cells()),
          lists_(workload) {
        lists_.offsets[workload.cells()] = workload.nodes;
    }

    std::pair<double, double> operator()(std::vector<cl_uint>& digests) {
        const auto begin = std::chrono::steady_clock::now();
        std::barrier barrier(static_cast<std::ptrdiff_t>(threads_));
        in_parallel(threads_, workload_.nodes,
                    [&](unsigned thread, std::uint64_t first, std::uint64_t last) {
                        cl_uint* counts = counts_.of(thread);
                        std::fill_n(counts, workload_.cells(), 0);
                        for (std::uint64_t i = first; i < last; ++i) ++counts[input_.cell(i)];
                        barrier.arrive_and_wait();
                        prefix_sums_.run(thread, counts_, lists_.offsets.data(), barrier);
                        scatter(first, last, counts);
                    });
        const double build = seconds_since(begin);
        read(lists_, digests, threads_);
        return {build, seconds_since(begin) - build};
    }

private:
    void scatter(std::uint64_t first, std::uint64_t last, cl_uint* next) {
        constexpr std::uint64_t batch = 32;
        std::array<cl_uint, batch> places;
        for (std::uint64_t i = first; i < last; i += batch) {
            const std::uint64_t size = std::min(batch, last - i);
            for (std::uint64_t j = 0; j < size; ++j) {
                places[j] = next[input_.cell(i + j)]++;
                prefetch_for_write(&lists_.records[places[j]]);
            }
            for (std::uint64_t j = 0; j < size; ++j)
                lists_.records[places[j]] = input_.record(i + j);
        }
    }

    Workload workload_;
    unsigned threads_;
    Input input_;
    Histograms counts_;
    PrefixSums prefix_sums_;
    Lists lists_;
};

/// A cache line of items.
struct alignas(64) Line {
    static constexpr std::size_t items_max = 64 / sizeof(Item);
    Item items[items_max];
};

/// Writes a cache line past the caches if the processor can.
inline void stream(Line& to, const Line& from) {
#if defined(__SSE2__)
    for (int i = 0; i < 4; ++i)
        _mm_stream_si128(reinterpret_cast<__m128i*>(&to) + i,
                         _mm_load_si128(reinterpret_cast<const __m128i*>(&from) + i));
#else
    to = from;
#endif
}

inline void finish_streams() {
#if defined(__SSE2__)
    _mm_sfence();
#endif
}

template <class Input>
class Partitioned {
public:
    Partitioned(const Workload& workload, unsigned threads, Input input)
        : workload_(workload),
          threads_(threads),
          input_(std::move(input)),
          shift_(shift_for(workload)),
          partitions_(((workload.cells() - 1) >> shift_) + 1),
          counts_(threads, partitions_),
          prefix_sums_(threads, partitions_),
          begins_(partitions_ + 1),
          buffers_(uninitialized<Line>(threads * partitions_)),
          lines_(uninitialized<Line>(workload.nodes / Line::items_max + 1)),
          lists_(workload) {
        begins_[partitions_] = workload.nodes;
        lists_.offsets[workload.cells()] = workload.nodes;
    }

    std::pair<double, double> operator()(std::vector<cl_uint>& digests) {
        const auto begin = std::chrono::steady_clock::now();
        std::barrier barrier(static_cast<std::ptrdiff_t>(threads_));
        std::atomic<std::size_t> next_partition = 0;
        in_parallel(threads_, workload_.nodes,
                    [&](unsigned thread, std::uint64_t first, std::uint64_t last) {
                        cl_uint* counts = counts_.of(thread);
                        std::fill_n(counts, partitions_, 0);
                        for (std::uint64_t i = first; i < last; ++i)
                            ++counts[input_.cell(i) >> shift_];
                        barrier.arrive_and_wait();
                        prefix_sums_.run(thread, counts_, begins_.data(), barrier);
                        partition(thread, first, last, counts);
                        barrier.arrive_and_wait();
                        std::vector<cl_uint> places(std::size_t{1} << shift_);
                        for (std::size_t p = next_partition++; p < partitions_;
                             p = next_partition++)
                            count_partition(p, places);
                    });
        const double build = seconds_since(begin);
        read(lists_, digests, threads_);
        return {build, seconds_since(begin) - build};
    }

private:
    /// At most 512 partitions of about 256 KiB of items, so that their lines fit the first cache.
    static unsigned shift_for(const Workload& workload) {
        const std::uint64_t wanted = std::uint64_t{workload.nodes} * sizeof(Item) / (256 << 10);
        const std::uint64_t partitions =
            std::clamp<std::uint64_t>(std::bit_ceil(wanted), 1, std::min(512u, workload.cells()));
        return static_cast<unsigned>(std::bit_width(workload.cells() / partitions)) - 1;
    }

    /// Moves a thread's items to their partitions. `next` is the offset of the next item of each.
    void partition(unsigned thread, std::uint64_t first, std::uint64_t last, cl_uint* next) {
        Line* buffers = &buffers_[thread * partitions_];
        std::vector<cl_uint> begins(next, next + partitions_);
        for (std::uint64_t i = first; i < last; ++i) {
            const cl_uint cell = input_.cell(i);
            const std::size_t p = cell >> shift_;
            const std::size_t slot = next[p] % Line::items_max;
            buffers[p].items[slot] = {cell, input_.record(i)};
            const cl_uint end = ++next[p];
            if (slot + 1 < Line::items_max) continue;
            // Another thread may share the first line of a thread's part of a partition.
            if (end - begins[p] >= Line::items_max)
                stream(lines_[(end - 1) / Line::items_max], buffers[p]);
            else
                copy(buffers[p], begins[p], end);
        }
        for (std::size_t p = 0; p < partitions_; ++p) {
            const auto line_begin =
                static_cast<cl_uint>(next[p] / Line::items_max * Line::items_max);
            copy(buffers[p], std::max(begins[p], line_begin), next[p]);
        }
        finish_streams();
    }

    /// Writes the items begin ... end - 1, which are in one line.
    void copy(const Line& buffer, cl_uint begin, cl_uint end) {
        for (cl_uint at = begin; at < end; ++at)
            lines_[at / Line::items_max].items[at % Line::items_max] =
                buffer.items[at % Line::items_max];
    }

    /// Counting sort of one partition.
    void count_partition(std::size_t p, std::vector<cl_uint>& places) {
        const cl_uint cells = std::min(1u << shift_, workload_.cells());
        const std::size_t first_cell = p << shift_;
        const Item* items = lines_[0].items;
        std::fill(places.begin(), places.end(), 0);
        for (cl_uint i = begins_[p]; i < begins_[p + 1]; ++i) ++places[items[i].cell & (cells - 1)];
        cl_uint at = begins_[p];
        for (cl_uint cell = 0; cell < cells; ++cell) {
            lists_.offsets[first_cell + cell] = at;
            at += std::exchange(places[cell], at);
        }
        for (cl_uint i = begins_[p]; i < begins_[p + 1]; ++i)
            lists_.records[places[items[i].cell & (cells - 1)]++] = items[i].record;
    }

    Workload workload_;
    unsigned threads_;
    Input input_;
    unsigned shift_;  ///< a cell's partition is cell >> shift_
    std::size_t partitions_;
    Histograms counts_;
    PrefixSums prefix_sums_;
    std::vector<cl_uint> begins_;  ///< of the partitions' items
    Array<Line> buffers_;          ///< a line for each thread and partition
    Array<Line> lines_;
    Lists lists_;
};

/// Sorts, reads, and returns the seconds of both.
using Sorter = std::function<std::pair<double, double>(std::vector<cl_uint>&)>;

template <template <class> class Sort, class Input>
Sorter sorter(const Workload& workload, unsigned threads, Input input) {
    return [sort = std::make_shared<Sort<Input>>(workload, threads, std::move(input))](
               std::vector<cl_uint>& digests) { return (*sort)(digests); };
}

template <template <class> class Sort>
Sorter generating(const Workload& workload, unsigned threads) {
    switch (workload.distribution.id) {
        case BENCH_COHERENT:
            return sorter<Sort>(workload, threads, Generated<BENCH_COHERENT>{workload.cells()});
        case BENCH_RUNS:
            return sorter<Sort>(workload, threads, Generated<BENCH_RUNS>{workload.cells()});
        case BENCH_SKEWED:
            return sorter<Sort>(workload, threads, Generated<BENCH_SKEWED>{workload.cells()});
        case BENCH_HOT:
            return sorter<Sort>(workload, threads, Generated<BENCH_HOT>{workload.cells()});
        default:
            return sorter<Sort>(workload, threads, Generated<BENCH_RANDOM>{workload.cells()});
    }
}

template <template <class> class Sort>
void add(Suite& suite, const std::string& name) {
    add_sort_path(suite, name + "/input:generated", [&suite](const Workload& workload) {
        return generating<Sort>(workload, suite.threads());
    });
    add_sort_path(suite, name + "/input:stored", [&suite](const Workload& workload) {
        return sorter<Sort>(workload, suite.threads(), Stored(workload));
    });
}

}  // namespace

void add_peer_counting_sort(Suite& suite) {
    add<Direct>(suite, "counting_sort");
    add<Partitioned>(suite, "counting_sort_partitioned");
}

}  // namespace bench
