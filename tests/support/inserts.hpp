// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <string>
#include <vector>

#include <cellist/cellist.hpp>

#include "support/catch.hpp"
#include "support/device.hpp"
#include "support/random.hpp"

namespace cellist::test {

/// The record of tests that do not care about its members. No two items of a test are equal.
struct Item {
    cl_float key;
    cl_uint id;
    friend bool operator==(const Item&, const Item&) = default;
};
CELLIST_STRUCT(Item, key, id);

/// Records and the index of the cell that each goes to; an index outside of the shape is rejected.
template <class T>
struct Inserts {
    std::vector<cl_uint> cells;
    std::vector<T> records;

    [[nodiscard]] std::size_t size() const { return cells.size(); }
    void add(cl_uint cell, const T& record) {
        cells.push_back(cell);
        records.push_back(record);
    }
    /// The same in another order.
    void shuffle(std::mt19937& random) {
        for (std::size_t i = size(); i > 1; --i) {
            const std::size_t j = below(random, static_cast<std::uint32_t>(i));
            std::swap(cells[i - 1], cells[j]);
            std::swap(records[i - 1], records[j]);
        }
    }
};

/// Items with random keys, ids from 0 up, in random cells of 0 ... cells - 1.
inline Inserts<Item> random_inserts(std::size_t count, std::uint32_t cells, std::mt19937& random) {
    Inserts<Item> inserts;
    for (std::size_t i = 0; i < count; ++i)
        inserts.add(below(random, cells),
                    {static_cast<cl_float>(below(random, 1000)) - 500.0f, static_cast<cl_uint>(i)});
    return inserts;
}

/// The kernel `insert_all` that makes inserts of a record type, one a work-item.
inline std::string insert_source(const std::string& record) {
    return R"(
#include <cellist/lists.clh>
kernel void insert_all(CELLIST_LISTS()" +
           record + R"(, lists), global const uint* cells, global const )" + record +
           R"(* records, uint count)
{
    const uint i = get_global_id(0);
    if (i < count) cellist_insert(lists, cells[i], records[i]);
}
)";
}

/// Runs Inserts on the device.
template <class T>
class Inserter {
public:
    explicit Inserter(const Lists<T>& lists, const Device& on = device())
        : device_(on), kernel_(on, insert_source(DeviceType<T>::name()), "insert_all", lists) {}

    BuildReport build(Lists<T>& lists, const Inserts<T>& inserts) {
        const Buffer<cl_uint> cells(device_, inserts.cells);
        const Buffer<T> records(device_, inserts.records);
        const auto count = static_cast<cl_uint>(inserts.size());
        return lists.build(kernel_, Range::padded(count, 64), cells, records, count);
    }

    /// Enqueues the inserts alone, for a build of several kernels, and waits for them.
    void run(Lists<T>& lists, const Inserts<T>& inserts) {
        const Buffer<cl_uint> cells(device_, inserts.cells);
        const Buffer<T> records(device_, inserts.records);
        const auto count = static_cast<cl_uint>(inserts.size());
        kernel_.run(Range::padded(count, 64), lists, cells, records, count);
        device_.finish();
    }

private:
    const Device& device_;
    Kernel kernel_;
};

/// Inserts on the device, for builds that are called several times or wait, and their kernel.
struct UploadedInserts {
    UploadedInserts(const Lists<Item>& lists, const Inserts<Item>& inserts,
                    const Device& on = device())
        : count(static_cast<cl_uint>(inserts.size())),
          cells(on, inserts.cells),
          records(on, inserts.records),
          kernel(on, insert_source("Item"), "insert_all", lists) {}
    /// Enqueues the inserts.
    void insert(const Lists<Item>& lists) {
        kernel.run(Range::padded(count, 64), lists, cells, records, count);
    }
    Pending<BuildReport> build_async(Lists<Item>& lists) {
        return lists.build_async(kernel, Range::padded(count, 64), cells, records, count);
    }

    cl_uint count;
    Buffer<cl_uint> cells;
    Buffer<Item> records;
    Kernel kernel;
};

/// What the lists must hold: records by cell, in no order.
template <class T>
using Oracle = std::multimap<std::uint64_t, T>;

template <class T>
Oracle<T> oracle_of(const Inserts<T>& inserts, std::uint64_t cells) {
    Oracle<T> oracle;
    for (std::size_t i = 0; i < inserts.size(); ++i)
        if (inserts.cells[i] < cells) oracle.emplace(inserts.cells[i], inserts.records[i]);
    return oracle;
}

/// Records as bytes in ascending order: a multiset that any type without padding can be compared
/// by.
template <class T, class Records>
std::vector<std::array<unsigned char, sizeof(T)>> sorted_bytes(const Records& records) {
    std::vector<std::array<unsigned char, sizeof(T)>> all;
    for (const T& record : records) {
        all.emplace_back();
        std::memcpy(all.back().data(), &record, sizeof(T));
    }
    std::sort(all.begin(), all.end());
    return all;
}

/// Requires that each cell holds exactly the oracle's records, in any order.
template <class T>
void require_same(const HostLists<T>& found, const Oracle<T>& oracle) {
    REQUIRE(found.records().size() == oracle.size());
    for (std::uint64_t cell = 0; cell < found.cells(); ++cell) {
        std::vector<T> expected;
        const auto [begin, end] = oracle.equal_range(cell);
        for (auto entry = begin; entry != end; ++entry) expected.push_back(entry->second);
        const auto list = found.cell(cell);
        if (sorted_bytes<T>(expected) == sorted_bytes<T>(list)) continue;
        FAIL("cell " << cell << " holds other records than expected: " << list.size() << " of "
                     << expected.size());
    }
}

/// Requires that a container is sound and that its parts agree on how many records it holds.
template <class T>
void require_sound(const Lists<T>& lists, std::uint64_t stored) {
    const Validation validation = lists.validate();
    INFO(validation.message());
    REQUIRE(validation.ok());
    REQUIRE(lists.lengths().total == stored);
}

/// Requires an exact report of a build in which all records fit.
inline void require_complete(const BuildReport& report, std::uint64_t stored,
                             std::uint64_t rejected = 0) {
    REQUIRE(report.attempted == stored + rejected);
    REQUIRE(report.stored == stored);
    REQUIRE(report.rejected == rejected);
    REQUIRE(report.dropped == 0);
    REQUIRE(report.capacity_nodes >= stored);
}

/// Runs of the kernel in a build that need not grow a pool of this capacity: Storage::counted
/// counts and fills, but on processors whose threads have partitions of the cells.
inline std::uint32_t passes_of(Storage storage, std::uint64_t capacity_nodes) {
    const DeviceInfo& info = device().info();
    const std::uint64_t threads = info.compute_units;
    const bool partitions =
        info.one_thread_per_work_group &&
        capacity_nodes >= 1024 * threads * std::max<std::uint64_t>(threads / 2, 1);
    return storage == Storage::counted && !partitions ? 2 : 1;
}

}  // namespace cellist::test
