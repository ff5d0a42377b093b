// SPDX-License-Identifier: MIT
#include "bucket_sort.hpp"

#include <algorithm>
#include <bit>
#include <string>
#include <utility>
#include <vector>

#include "bucket_sort_kernels.hpp"
#include "stopwatch.hpp"

namespace bucket_sort {
namespace {

// Short lists are sorted fastest, but each costs a little.
constexpr std::size_t records_a_bucket = 8;
constexpr cl_uint buckets_a_part = 64;
// Parts differ in size by about 1 / sqrt(samples a part).
constexpr std::size_t samples_a_part = 16;
constexpr std::size_t records_a_part = records_a_bucket * buckets_a_part;

cl_uint parts_of(std::size_t records) {
    return static_cast<cl_uint>(std::max<std::size_t>(1, records / records_a_part));
}

cellist::Source source() {
    return {.text = std::string(kernels::bucket_sort_cl),
            .file_name = "bucket_sort.cl",
            .options = "-DBUCKETS_A_PART=" + std::to_string(buckets_a_part) + "u"};
}

}  // namespace

BucketSort::BucketSort(const cellist::Device& device, std::size_t records, cellist::Storage storage)
    : device_(device),
      count_(static_cast<cl_uint>(records)),
      parts_(parts_of(records)),
      buckets_(device, {std::uint64_t{parts_} * buckets_a_part}, {.storage = storage}),
      bucket_(device, records),
      take_sample_(device, source(), "take_sample", buckets_),
      find_buckets_(device, source(), "find_buckets", buckets_),
      insert_(device, source(), "insert_records", buckets_) {}

std::vector<cl_ulong> BucketSort::choose_bounds(const cellist::Buffer<cl_uint>& keys,
                                                const cellist::Buffer<cl_uint>& payloads,
                                                cl_ulong payload_limit) {
    std::vector<cl_ulong> bounds{0};
    const std::size_t size = std::min<std::size_t>(count_, samples_a_part * parts_);
    if (size > 0) {
        const cellist::Buffer<cl_ulong> drawn(device_, size);
        take_sample_.run(size, keys, payloads, payload_limit, count_, static_cast<cl_uint>(size),
                         drawn);
        std::vector<cl_ulong> sample = drawn.download();
        std::sort(sample.begin(), sample.end());
        // Beyond the sample there is next to nothing, and its ends are closer than those of the
        // numbers: the first and the last part are divided as finely as the others.
        bounds.front() = sample.front();
        for (std::size_t part = 1; part < parts_; ++part)
            bounds.push_back(sample[part * size / parts_]);
        bounds.push_back(sample.back() + 1);
    } else {
        bounds.push_back(1);
    }
    return bounds;
}

cellist::Buffer<Record> BucketSort::sort(const cellist::Buffer<cl_uint>& keys,
                                         const cellist::Buffer<cl_uint>& payloads,
                                         std::uint64_t payload_limit) {
    const cl_ulong limit = payload_limit;
    std::vector<cl_ulong> bounds;
    times_.sample_ms =
        support::measure_ms(device_, [&] { bounds = choose_bounds(keys, payloads, limit); });
    const cellist::Buffer<cl_ulong> device_bounds(device_, bounds);
    times_.insert_ms = support::measure_ms(device_, [&] {
        const auto range = cellist::Range::padded(count_);
        const cl_uint parts_half = parts_ > 1 ? std::bit_floor(parts_ - 1) : 0;
        find_buckets_.run(range, keys, payloads, count_, limit, device_bounds, parts_, parts_half,
                          bucket_);
        buckets_.build(insert_, range, keys, payloads, bucket_, count_);
    });
    times_.sort_ms = support::measure_ms(device_, [&] { buckets_.sort(&Record::key); });
    cellist::Packed<Record> packed{{device_, 0}, {device_, 0}};
    times_.pack_ms = support::measure_ms(device_, [&] { packed = buckets_.pack(); });
    return std::move(packed.records);
}

}  // namespace bucket_sort
