// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <cellist/cellist.hpp>

namespace bucket_sort {

struct Record {
    cl_uint key;
    cl_uint payload;
    friend auto operator<=>(const Record&, const Record&) = default;
};
CELLIST_STRUCT(Record, key, payload);

/// Milliseconds of the passes of a sort.
struct Times {
    double sample_ms = 0;
    double insert_ms = 0;
    double sort_ms = 0;
    double pack_ms = 0;
    [[nodiscard]] double sum() const { return sample_ms + insert_ms + sort_ms + pack_ms; }
};

/// Sorts keys with payloads through per-cell lists, a list for each bucket.
class BucketSort {
public:
    /// For up to 2^31 records. Allocates the lists; their pool grows in the first sort.
    BucketSort(const cellist::Device& device, std::size_t records, cellist::Storage storage);

    /// The records in ascending order, by key, then by payload: stable where payloads ascend. All
    /// payloads are below `payload_limit`, at most 2^32; the closer, the more even the buckets.
    /// Both buffers hold the number of records that the sort was made for. Blocks. The result does
    /// not depend on how the work is scheduled.
    [[nodiscard]] cellist::Buffer<Record> sort(const cellist::Buffer<cl_uint>& keys,
                                               const cellist::Buffer<cl_uint>& payloads,
                                               std::uint64_t payload_limit);

    /// Of the last sort.
    [[nodiscard]] const Times& times() const { return times_; }
    [[nodiscard]] const cellist::Lists<Record>& buckets() const { return buckets_; }

private:
    // Where the parts begin, from a sorted sample.
    std::vector<cl_ulong> choose_bounds(const cellist::Buffer<cl_uint>& keys,
                                        const cellist::Buffer<cl_uint>& payloads,
                                        cl_ulong payload_limit);

    const cellist::Device& device_;
    cl_uint count_;
    cl_uint parts_;
    cellist::Lists<Record> buckets_;
    cellist::Buffer<cl_uint> bucket_;
    cellist::Kernel take_sample_;
    cellist::Kernel find_buckets_;
    cellist::Kernel insert_;
    Times times_;
};

}  // namespace bucket_sort
