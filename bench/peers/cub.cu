// SPDX-License-Identifier: MIT
// CUB on an NVIDIA GPU, as a separate program. It sorts the same input as cellist_bench, and prints
// the times in the JSON of Google Benchmark.
//
//   sort_path        DeviceRadixSort of the records by their cell, over as many bits as cells have,
//                    then bounds and one read of every list:
//     cub_values     the records as values, 12 bytes
//     cub_values_16  padded to 16 bytes
//     cub_gather     indices as values, then the records gathered by them
//     cub_index      indices as values, through which the records are read
//   segmented_sort   DeviceSegmentedSort of lists of one length by their key:
//     cub_values     with the rest of the record as value
//     cub_gather     with indices as values, then the rests gathered by them
//
// Host time from the first launch until the device is done. Each run of sort_path reads once more,
// to time the read alone. The input is in memory, and temporary memory is allocated before. The
// results of each case are checked once, before it is timed. Cases that do not fit on the device
// are left out, and named on stderr. The JSON names those that fail, and the exit status is then 1.

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <functional>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include <cub/device/device_radix_sort.cuh>
#include <cub/device/device_segmented_sort.cuh>

#include "support/distribution.h"

namespace {

void check(cudaError_t error, const char* what) {
    if (error != cudaSuccess)
        throw std::runtime_error(std::string(what) + ": " + cudaGetErrorString(error));
}
#define CHECK(call) check(call, #call)

/// `size` elements in device memory.
template <class T>
class Buffer {
public:
    explicit Buffer(std::size_t size) {
        CHECK(cudaMalloc(&data_, std::max<std::size_t>(size, 1) * sizeof(T)));
    }
    ~Buffer() { cudaFree(data_); }
    Buffer(const Buffer&) = delete;
    Buffer& operator=(const Buffer&) = delete;
    T* get() const { return data_; }

private:
    T* data_ = nullptr;
};

struct Record {
    std::uint32_t words[3];
};

struct Workload {
    const char* distribution;
    std::uint32_t id;
    std::uint32_t occupancy;
    std::uint32_t nodes;

    std::uint32_t cells() const { return bench_cells(nodes, occupancy); }
    /// The same, halved until one thread can traverse each list.
    Workload readable() const {
        return {distribution, id, occupancy, bench_readable_nodes(nodes, occupancy, id)};
    }
    int cell_bits() const {
        int bits = 0;
        while ((1u << bits) < cells()) ++bits;
        return std::max(bits, 1);
    }
    std::string name() const {
        return std::string("distribution:") + distribution +
               "/node_bytes:16/occupancy:" + std::to_string(occupancy) +
               "/nodes:" + std::to_string(nodes);
    }
};

__device__ Record record_of(std::uint32_t i) {
    return {{bench_word(i, 0), bench_word(i, 1), bench_word(i, 2)}};
}

__device__ std::uint32_t digest_of(const Record& record) {
    std::uint32_t digest = 0;
    for (std::uint32_t j = 0; j < 3; ++j) digest += bench_digest_word(record.words[j], j);
    return digest;
}

__device__ Record record_in(const Record& record) { return record; }
__device__ Record record_in(const uint4& value) { return {{value.x, value.y, value.z}}; }
__device__ void put(Record& to, const Record& record) { to = record; }
__device__ void put(uint4& to, const Record& record) {
    to = make_uint4(record.words[0], record.words[1], record.words[2], 0);
}

constexpr unsigned group = 256;
unsigned groups(std::size_t items) { return static_cast<unsigned>((items + group - 1) / group); }
__device__ std::uint32_t global_id() { return blockIdx.x * blockDim.x + threadIdx.x; }

template <class T>
__global__ void store_input(std::uint32_t* cells, T* records, std::uint32_t count,
                            std::uint32_t cell_count, std::uint32_t distribution) {
    const std::uint32_t i = global_id();
    if (i >= count) return;
    cells[i] = bench_cell(i, cell_count, distribution);
    put(records[i], record_of(i));
}

__global__ void store_indices(std::uint32_t* indices, std::uint32_t count) {
    const std::uint32_t i = global_id();
    if (i < count) indices[i] = i;
}

/// The expected digest of every list, computed without a sort.
__global__ void add_digests(std::uint32_t* digests, std::uint32_t count, std::uint32_t cell_count,
                            std::uint32_t distribution) {
    const std::uint32_t i = global_id();
    if (i < count)
        atomicAdd(&digests[bench_cell(i, cell_count, distribution)], digest_of(record_of(i)));
}

/// Finds where each cell's items begin in sorted cells; offsets has cell_count + 1 elements.
__global__ void find_bounds(const std::uint32_t* cells, std::uint32_t count,
                            std::uint32_t cell_count, std::uint32_t* offsets) {
    const std::uint32_t i = global_id();
    if (i > count) return;
    const std::uint32_t first = i == 0 ? 0 : cells[i - 1] + 1;
    const std::uint32_t last = i == count ? cell_count : cells[i];
    for (std::uint32_t cell = first; cell <= last; ++cell) offsets[cell] = i;
}

template <class T>
__global__ void read(const std::uint32_t* offsets, const T* records, std::uint32_t* digests,
                     std::uint32_t cell_count) {
    const std::uint32_t cell = global_id();
    if (cell >= cell_count) return;
    const std::uint32_t end = offsets[cell + 1];
    std::uint32_t digest = 0;
    for (std::uint32_t i = offsets[cell]; i < end; ++i) digest += digest_of(record_in(records[i]));
    digests[cell] = digest;
}

__global__ void read_indexed(const std::uint32_t* offsets, const std::uint32_t* indices,
                             const Record* records, std::uint32_t* digests,
                             std::uint32_t cell_count) {
    const std::uint32_t cell = global_id();
    if (cell >= cell_count) return;
    const std::uint32_t end = offsets[cell + 1];
    std::uint32_t digest = 0;
    for (std::uint32_t i = offsets[cell]; i < end; ++i) digest += digest_of(records[indices[i]]);
    digests[cell] = digest;
}

__global__ void gather(const std::uint32_t* indices, const Record* from, Record* to,
                       std::uint32_t count) {
    const std::uint32_t i = global_id();
    if (i < count) to[i] = from[indices[i]];
}

struct Sampling {
    std::size_t least = 7, most = 101;
    double seconds = 0.3;
};

double median(std::vector<double> seconds) {
    std::sort(seconds.begin(), seconds.end());
    const std::size_t middle = seconds.size() / 2;
    return seconds.size() % 2 == 1 ? seconds[middle] : (seconds[middle - 1] + seconds[middle]) / 2;
}

/// Prints the cases in the form of Google Benchmark.
class Report {
public:
    Report() {
        cudaDeviceProp device;
        int driver = 0, current = 0;
        CHECK(cudaGetDevice(&current));
        CHECK(cudaGetDeviceProperties(&device, current));
        CHECK(cudaDriverGetVersion(&driver));
        std::printf(
            "{\n  \"context\": {\"device\": \"%s\", \"cuda_driver\": \"%d.%d\", \"cub\": "
            "\"%d\"},\n",
            device.name, driver / 1000, driver % 1000 / 10, CUB_VERSION);
        std::printf("  \"benchmarks\": [");
    }
    ~Report() { std::printf("\n  ]\n}\n"); }

    /// `counters` are further seconds of each run, by the name of their median in milliseconds.
    void add(const std::string& name, const std::vector<double>& seconds, std::uint32_t nodes,
             const std::map<std::string, std::vector<double>>& counters = {}) {
        const auto [least, greatest] = std::minmax_element(seconds.begin(), seconds.end());
        begin(name);
        std::printf(
            "\"real_time\": %.6f, \"time_unit\": \"ms\", \"items_per_second\": %.6g, "
            "\"least_ms\": %.6f, \"greatest_ms\": %.6f, \"samples\": %zu",
            1e3 * median(seconds), nodes / median(seconds), 1e3 * *least, 1e3 * *greatest,
            seconds.size());
        for (const auto& counter : counters)
            std::printf(", \"%s\": %.6f", counter.first.c_str(), 1e3 * median(counter.second));
        std::printf("}");
        std::fflush(stdout);
    }

    /// Calls `measure`, which adds cases. Its exceptions are reported under this name: of a case,
    /// or of several cases with a common setup.
    void attempt(const std::string& name, const std::function<void()>& measure) try {
        measure();
    } catch (const std::exception& error) {
        cudaGetLastError();  // forgets it: the next case would find it
        std::string message = error.what();
        for (char& c : message)
            if (c == '"' || c == '\\' || static_cast<unsigned char>(c) < ' ') c = '\'';
        begin(name);
        std::printf("\"error_occurred\": true, \"error_message\": \"%s\"}", message.c_str());
        std::fflush(stdout);
        failed_ = true;
    }

    bool failed() const { return failed_; }

private:
    void begin(const std::string& name) {
        std::printf("%s\n    {\"name\": \"%s\", ", first_ ? "" : ",", name.c_str());
        first_ = false;
    }

    bool first_ = true;
    bool failed_ = false;
};

double host_seconds(const std::function<void()>& work) {
    CHECK(cudaDeviceSynchronize());
    const auto begin = std::chrono::steady_clock::now();
    work();
    CHECK(cudaGetLastError());
    CHECK(cudaDeviceSynchronize());
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// Calls `run` as often as `sampling` says. Each call returns the seconds of one run.
std::vector<double> sample(const Sampling& sampling, const std::function<double()>& run) {
    const auto begin = std::chrono::steady_clock::now();
    std::vector<double> seconds;
    while (seconds.size() < sampling.least ||
           (seconds.size() < sampling.most &&
            std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count() <
                sampling.seconds))
        seconds.push_back(run());
    return seconds;
}

/// Throws unless two buffers are equal.
void compare(const Buffer<std::uint32_t>& found, const Buffer<std::uint32_t>& expected,
             std::size_t size) {
    std::vector<std::uint32_t> a(size), b(size);
    CHECK(cudaMemcpy(a.data(), found.get(), size * sizeof(a[0]), cudaMemcpyDeviceToHost));
    CHECK(cudaMemcpy(b.data(), expected.get(), size * sizeof(b[0]), cudaMemcpyDeviceToHost));
    if (a != b) throw std::runtime_error("the lists are wrong");
}

/// The input and the results of a workload.
struct SortPath {
    explicit SortPath(const Workload& w)
        : workload(w),
          input_cells(w.nodes),
          cells(w.nodes),
          offsets(w.cells() + 1),
          digests(w.cells()),
          expected(w.cells()) {
        CHECK(cudaMemset(expected.get(), 0, w.cells() * sizeof(std::uint32_t)));
        add_digests<<<groups(w.nodes), group>>>(expected.get(), w.nodes, w.cells(), w.id);
    }

    void bounds() {
        find_bounds<<<groups(workload.nodes + std::size_t{1}), group>>>(
            cells.get(), workload.nodes, workload.cells(), offsets.get());
    }

    void measure(Report& report, const Sampling& sampling, const std::string& peer,
                 const std::function<void()>& build, const std::function<void()>& read) {
        const std::string name = "sort_path/peer:" + peer + "/" + workload.name();
        report.attempt(name, [&] {
            CHECK(cudaMemset(digests.get(), 0, workload.cells() * sizeof(std::uint32_t)));
            std::vector<double> builds, reads;
            const auto run = [&] {
                const double both = host_seconds([&] {
                    build();
                    read();
                });
                reads.push_back(host_seconds(read));
                builds.push_back(both - reads.back());
                return both;
            };
            run();
            compare(digests, expected, workload.cells());
            builds.clear();
            reads.clear();
            const std::vector<double> seconds = sample(sampling, run);
            report.add(name, seconds, workload.nodes, {{"build_ms", builds}, {"read_ms", reads}});
        });
    }

    Workload workload;
    Buffer<std::uint32_t> input_cells, cells, offsets, digests, expected;
};

/// The size of CUB's temporary memory, which `sort` returns if it gets none.
template <class Sort>
std::size_t temporary_bytes(const Sort& sort) {
    std::size_t bytes = 0;
    CHECK(sort(nullptr, bytes));
    return bytes;
}

template <class Value>
void sort_values(Report& report, const Sampling& sampling, const Workload& w, const char* peer) {
    SortPath path(w);
    Buffer<Value> input(w.nodes), values(w.nodes);
    store_input<<<groups(w.nodes), group>>>(path.input_cells.get(), input.get(), w.nodes, w.cells(),
                                            w.id);
    const auto sort = [&](void* memory, std::size_t& bytes) {
        return cub::DeviceRadixSort::SortPairs(memory, bytes, path.input_cells.get(),
                                               path.cells.get(), input.get(), values.get(), w.nodes,
                                               0, w.cell_bits());
    };
    std::size_t bytes = temporary_bytes(sort);
    Buffer<char> memory(bytes);
    path.measure(
        report, sampling, peer,
        [&] {
            CHECK(sort(memory.get(), bytes));
            path.bounds();
        },
        [&] {
            read<<<groups(w.cells()), group>>>(path.offsets.get(), values.get(), path.digests.get(),
                                               w.cells());
        });
}

void sort_indices(Report& report, const Sampling& sampling, const Workload& w) {
    SortPath path(w);
    Buffer<Record> records(w.nodes), gathered(w.nodes);
    Buffer<std::uint32_t> input(w.nodes), indices(w.nodes);
    store_input<<<groups(w.nodes), group>>>(path.input_cells.get(), records.get(), w.nodes,
                                            w.cells(), w.id);
    store_indices<<<groups(w.nodes), group>>>(input.get(), w.nodes);
    const auto sort = [&](void* memory, std::size_t& bytes) {
        return cub::DeviceRadixSort::SortPairs(memory, bytes, path.input_cells.get(),
                                               path.cells.get(), input.get(), indices.get(),
                                               w.nodes, 0, w.cell_bits());
    };
    std::size_t bytes = temporary_bytes(sort);
    Buffer<char> memory(bytes);
    path.measure(
        report, sampling, "cub_gather",
        [&] {
            CHECK(sort(memory.get(), bytes));
            gather<<<groups(w.nodes), group>>>(indices.get(), records.get(), gathered.get(),
                                               w.nodes);
            path.bounds();
        },
        [&] {
            read<<<groups(w.cells()), group>>>(path.offsets.get(), gathered.get(),
                                               path.digests.get(), w.cells());
        });
    path.measure(
        report, sampling, "cub_index",
        [&] {
            CHECK(sort(memory.get(), bytes));
            path.bounds();
        },
        [&] {
            read_indexed<<<groups(w.cells()), group>>>(
                path.offsets.get(), indices.get(), records.get(), path.digests.get(), w.cells());
        });
}

/// Contiguous lists in the order of insertion: list c holds the records c, c + cells, ...
__global__ void store_lists(std::uint32_t* keys, uint2* rests, std::uint32_t count,
                            std::uint32_t cell_count, std::uint32_t length) {
    const std::uint32_t at = global_id();
    if (at >= count) return;
    const std::uint32_t i = at / length + at % length * cell_count;
    keys[at] = bench_word(i, 0);
    rests[at] = make_uint2(bench_word(i, 1), bench_word(i, 2));
}

__global__ void store_ends(std::uint32_t* offsets, std::uint32_t cell_count, std::uint32_t length) {
    const std::uint32_t cell = global_id();
    if (cell <= cell_count) offsets[cell] = cell * length;
}

__global__ void count_unsorted(const std::uint32_t* keys, std::uint32_t count, std::uint32_t length,
                               std::uint32_t* unsorted) {
    const std::uint32_t at = global_id();
    if (at < count && at % length != 0 && keys[at] < keys[at - 1]) atomicAdd(unsorted, 1);
}

__global__ void gather_rests(const std::uint32_t* indices, const uint2* from, uint2* to,
                             std::uint32_t count) {
    const std::uint32_t at = global_id();
    if (at < count) to[at] = from[indices[at]];
}

/// Sorts keys with values, and calls `finish` with the sorted values, which sorts the records.
template <class Value, class Finish>
void sort_segments(Report& report, const Sampling& sampling, const Workload& w, const char* peer,
                   const std::uint32_t* keys, const Value* values, const Finish& finish) {
    const std::uint32_t length = w.nodes / w.cells();
    const std::string name = std::string("segmented_sort/peer:") + peer + "/" + w.name();
    Buffer<std::uint32_t> offsets(w.cells() + 1), sorted_keys(w.nodes), unsorted(1), none(1);
    Buffer<Value> sorted_values(w.nodes);
    store_ends<<<groups(w.cells() + std::size_t{1}), group>>>(offsets.get(), w.cells(), length);
    const auto sort = [&](void* memory, std::size_t& bytes) {
        return cub::DeviceSegmentedSort::SortPairs(memory, bytes, keys, sorted_keys.get(), values,
                                                   sorted_values.get(), w.nodes, w.cells(),
                                                   offsets.get(), offsets.get() + 1);
    };
    std::size_t bytes = temporary_bytes(sort);
    Buffer<char> memory(bytes);
    const auto work = [&] {
        CHECK(sort(memory.get(), bytes));
        finish(sorted_values.get());
    };
    report.attempt(name, [&] {
        host_seconds(work);
        CHECK(cudaMemset(unsorted.get(), 0, sizeof(std::uint32_t)));
        CHECK(cudaMemset(none.get(), 0, sizeof(std::uint32_t)));
        // If the number of cells does not divide the nodes, the last few belong to no list.
        const std::uint32_t sorted = length * w.cells();
        count_unsorted<<<groups(sorted), group>>>(sorted_keys.get(), sorted, length,
                                                  unsorted.get());
        compare(unsorted, none, 1);
        report.add(name, sample(sampling, [&] { return host_seconds(work); }), w.nodes);
    });
}

void segmented_sort(Report& report, const Sampling& sampling, const Workload& w) {
    Buffer<std::uint32_t> keys(w.nodes), indices(w.nodes);
    Buffer<uint2> rests(w.nodes);
    store_lists<<<groups(w.nodes), group>>>(keys.get(), rests.get(), w.nodes, w.cells(),
                                            w.nodes / w.cells());
    store_indices<<<groups(w.nodes), group>>>(indices.get(), w.nodes);
    sort_segments(report, sampling, w, "cub_values", keys.get(), rests.get(), [](uint2*) {});
    Buffer<uint2> gathered(w.nodes);
    sort_segments(report, sampling, w, "cub_gather", keys.get(), indices.get(),
                  [&](const std::uint32_t* sorted) {
                      gather_rests<<<groups(w.nodes), group>>>(sorted, rests.get(), gathered.get(),
                                                               w.nodes);
                  });
}

/// Whether there is room for keys of 4 bytes and values of 16, in and out, as much again for CUB's
/// temporary memory, and three words for each cell.
bool fits(const Workload& w) {
    std::size_t free = 0, total = 0;
    // A device that cannot answer is broken: the case then fails with its name.
    if (cudaMemGetInfo(&free, &total) != cudaSuccess) return true;
    const bool room = std::size_t{w.nodes} * 80 + std::size_t{w.cells()} * 12 < free;
    if (!room) std::fprintf(stderr, "left out, not enough memory: %s\n", w.name().c_str());
    return room;
}

std::uint32_t number(const std::string& text) {
    return static_cast<std::uint32_t>(std::strtoul(text.c_str(), nullptr, 10));
}

}  // namespace

int main(int argc, char** argv) try {
    std::uint32_t nodes = 1u << 26, occupancy = 16;
    Sampling sampling;
    bool full = false;
    for (int i = 1; i < argc; ++i) {
        const std::string argument = argv[i];
        const std::string value =
            argument.substr(std::min(argument.size(), argument.find('=') + 1));
        if (argument.rfind("--nodes=", 0) == 0 && number(value) > 0)
            nodes = number(value);
        else if (argument.rfind("--occupancy=", 0) == 0 && number(value) > 0)
            occupancy = number(value);
        else if (argument.rfind("--bus=", 0) == 0) {
            int device = 0;
            if (cudaDeviceGetByPCIBusId(&device, value.c_str()) != cudaSuccess)
                throw std::runtime_error("--bus=" + value +
                                         " is no CUDA device; nvidia-smi lists them");
            CHECK(cudaSetDevice(device));
        } else if (argument == "--effort=tiny")
            sampling = {1, 1, 0};
        else if (argument == "--effort=full")
            full = true;
        else if (argument != "--effort=quick") {
            std::fprintf(stderr,
                         "usage: cellist_bench_cub [--nodes=N] [--occupancy=K] "
                         "[--effort=tiny|quick|full] [--bus=DOMAIN:BUS:DEVICE.FUNCTION]\n");
            return 2;
        }
    }

    // Full effort adds the same cells with a quarter of the records.
    std::vector<Workload> workloads;
    for (const std::uint32_t divisor : {1u, 4u}) {
        if (divisor > 1 && (!full || occupancy < divisor)) continue;
        const std::uint32_t a_cell = occupancy / divisor, all = nodes / divisor;
        for (const Workload& base : {Workload{"random", BENCH_RANDOM, a_cell, all},
                                     Workload{"coherent", BENCH_COHERENT, a_cell, all},
                                     Workload{"runs", BENCH_RUNS, a_cell, all},
                                     Workload{"skewed", BENCH_SKEWED, a_cell, all},
                                     Workload{"hot", BENCH_HOT, a_cell, all}})
            workloads.push_back(base.readable());
    }

    Report report;
    for (const Workload& w : workloads) {
        if (!fits(w)) continue;
        report.attempt("sort_path/peer:cub_values/" + w.name(),
                       [&] { sort_values<Record>(report, sampling, w, "cub_values"); });
        report.attempt("sort_path/peer:cub_values_16/" + w.name(),
                       [&] { sort_values<uint4>(report, sampling, w, "cub_values_16"); });
        report.attempt("sort_path/peer:cub_gather,cub_index/" + w.name(),
                       [&] { sort_indices(report, sampling, w); });
    }
    for (const std::uint32_t length : {8u, 16u, 32u, 64u}) {
        const Workload w{"coherent", BENCH_COHERENT, length, nodes};
        if (fits(w))
            report.attempt("segmented_sort/peer:cub_values,cub_gather/" + w.name(),
                           [&] { segmented_sort(report, sampling, w); });
    }
    return report.failed() ? 1 : 0;
} catch (const std::exception& error) {
    std::fprintf(stderr, "cellist_bench_cub: %s\n", error.what());
    return 1;
}
