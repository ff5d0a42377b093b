// SPDX-License-Identifier: MIT
// The bucket sort sorts, whatever the keys and payloads.
#include "bucket_sort.hpp"

#include <algorithm>
#include <random>
#include <vector>

#include <cellist/cellist.hpp>

#include "distributions.hpp"
#include "support/catch.hpp"
#include "support/device.hpp"

namespace cellist::test {
namespace {

using bucket_sort::Record;

void require_sorted(const std::vector<cl_uint>& keys, const std::vector<cl_uint>& payloads,
                    std::uint64_t payload_limit) {
    std::vector<Record> expected;
    for (std::size_t i = 0; i < keys.size(); ++i) expected.push_back({keys[i], payloads[i]});
    std::sort(expected.begin(), expected.end());
    for (const Storage storage : {Storage::linked, Storage::counted}) {
        bucket_sort::BucketSort sort(device(), keys.size(), storage);
        const Buffer<cl_uint> device_keys(device(), keys), device_payloads(device(), payloads);
        for (int run = 0; run < 2; ++run)
            CHECK(sort.sort(device_keys, device_payloads, payload_limit).download() == expected);
    }
}

TEST_CASE("every distribution in every size") {
    for (const std::size_t count : {0U, 1U, 2U, 7U, 93U, 511U, 512U, 513U, 1024U, 4096U, 30000U})
        for (std::size_t i = 0; i < bucket_sort::distributions.size(); ++i) {
            INFO(bucket_sort::distributions[i] << ", " << count);
            std::vector<cl_uint> positions(count);
            for (std::size_t k = 0; k < count; ++k) positions[k] = static_cast<cl_uint>(k);
            require_sorted(bucket_sort::make_keys(i, count, 3), positions,
                           std::max<std::size_t>(count, 1));
        }
}

TEST_CASE("payloads of any value, and equal records") {
    std::mt19937 random(5);
    std::vector<cl_uint> keys(3000), payloads(3000);
    for (std::size_t i = 0; i < keys.size(); ++i) {
        keys[i] = random() % 3 == 0 ? 0xFFFFFFFF : static_cast<cl_uint>(random() % 5);
        payloads[i] = static_cast<cl_uint>(random());
    }
    require_sorted(keys, payloads, std::uint64_t{1} << 32);
    require_sorted(keys, std::vector<cl_uint>(keys.size(), 0xFFFFFFFF), std::uint64_t{1} << 32);
    require_sorted(std::vector<cl_uint>(keys.size(), 0xFFFFFFFF),
                   std::vector<cl_uint>(keys.size(), 0), 1);
}

TEST_CASE("equal keys do not make a bucket long") {
    constexpr std::size_t count = 100'000;
    std::vector<cl_uint> positions(count);
    for (std::size_t k = 0; k < count; ++k) positions[k] = static_cast<cl_uint>(k);
    for (std::size_t i = 0; i < bucket_sort::distributions.size(); ++i) {
        bucket_sort::BucketSort sort(device(), count, Storage::counted);
        const Buffer<cl_uint> keys(device(), bucket_sort::make_keys(i, count, 1));
        (void)sort.sort(keys, Buffer<cl_uint>(device(), positions), count);
        CHECK(sort.buckets().lengths().longest < 2048);
    }
}

}  // namespace
}  // namespace cellist::test
