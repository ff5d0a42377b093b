// SPDX-License-Identifier: MIT
#include "selftest.hpp"

#include <algorithm>
#include <functional>
#include <map>
#include <optional>
#include <ostream>
#include <random>
#include <sstream>
#include <string>
#include <tuple>
#include <vector>

#include <cellist/cellist.hpp>

namespace cellist::command {

struct SelftestRecord {
    cl_float key;
    cl_uint id;
};
CELLIST_STRUCT(SelftestRecord, key, id);

/// One insert that the kernel makes.
struct SelftestInsert {
    cl_int x;
    cl_int y;
    SelftestRecord record;
};
CELLIST_STRUCT(SelftestInsert, x, y, record);

namespace {

constexpr auto selftest_source = R"(
#include <cellist/lists.clh>

kernel void selftest_insert(CELLIST_LISTS(SelftestRecord, lists),
                            global const SelftestInsert* inserts, uint count)
{
    uint i = get_global_id(0);
    if (i >= count) return;
    SelftestInsert in = inserts[i];
    cellist_insert(lists, cellist_cell2(lists, in.x, in.y), in.record);
}

kernel void selftest_nearest(CELLIST_LISTS(SelftestRecord, lists), global SelftestRecord* out,
                             global uint* found)
{
    uint cell = get_global_id(0);
    if (cell >= cellist_cells(lists)) return;
    SelftestRecord nearest[4];
    found[cell] = cellist_nearest(lists, cell, key, 4, nearest);
    for (uint i = 0; i < found[cell]; ++i) out[cell * 4 + i] = nearest[i];
}
)";

using Record = std::tuple<cl_float, cl_uint>;
using Oracle = std::map<std::uint64_t, std::vector<Record>>;  ///< sorted records by cell

constexpr std::uint64_t width = 61;
constexpr std::uint64_t height = 47;

/// The number of inserts: enough for long lists, and few enough for the device's memory.
std::size_t insert_count(const DeviceInfo& device) {
    const std::uint64_t most =
        std::min(device.max_allocation_bytes / 64, device.global_memory_bytes / 256);
    return std::clamp<std::uint64_t>(most, 1000, 200'000);
}

std::string text_of(const Record& record) {
    std::ostringstream text;
    text << "(" << std::get<0>(record) << ", " << std::get<1>(record) << ")";
    return text.str();
}

/// The first difference between two lists; empty if they are equal.
std::string difference(std::uint64_t cell, const std::vector<Record>& expected,
                       const std::vector<Record>& found) {
    const std::string where = "cell " + std::to_string(cell) + ": ";
    if (expected.size() != found.size())
        return where + "expected " + std::to_string(expected.size()) + " records, found " +
               std::to_string(found.size());
    for (std::size_t i = 0; i < expected.size(); ++i)
        if (expected[i] != found[i])
            return where + "expected " + text_of(expected[i]) + " as record " + std::to_string(i) +
                   ", found " + text_of(found[i]);
    return {};
}

std::string difference(const char* what, std::uint64_t expected, std::uint64_t found) {
    if (expected == found) return {};
    return std::string(what) + ": expected " + std::to_string(expected) + ", found " +
           std::to_string(found);
}

/// The first text that is not empty.
std::string first_of(std::initializer_list<std::string> differences) {
    for (const std::string& text : differences)
        if (!text.empty()) return text;
    return {};
}

class Selftest {
public:
    explicit Selftest(const Device& device) : device_(device) {
        std::mt19937 random(20100628);
        inserts_.resize(insert_count(device.info()));
        // One long list has a quarter of the records. Its inserts come last, so that a test can
        // leave them out: the longest list decides the number of fixed slots for all cells.
        even_ = inserts_.size() - inserts_.size() / 4;
        for (cl_uint i = 0; SelftestInsert & insert : inserts_) {
            const bool hot = i >= even_;
            insert.x = hot ? 7 : static_cast<cl_int>(random() % (width + 2)) - 1;
            insert.y = hot ? 9 : static_cast<cl_int>(random() % (height + 2)) - 1;
            insert.record = {static_cast<cl_float>(random() % 1000) - 500.0f, i++};
        }
    }

    std::string grows_and_counts() {
        const BuildReport report = build(lists(), inserts_.size());
        const std::uint64_t stored = stored_of(inserts_.size());
        return first_of({difference("attempted", inserts_.size(), report.attempted),
                         difference("rejected", inserts_.size() - stored, report.rejected),
                         difference("stored", stored, report.stored),
                         difference("dropped", 0, report.dropped),
                         difference("passes", 2, report.passes), lists_state(*lists_)});
    }

    std::string sorts() { return sorted_difference(lists(), inserts_.size()); }

    std::string fills_other_storages() {
        for (const Storage storage : {Storage::counted, Storage::fixed}) {
            Lists<SelftestRecord> other(device_, {width, height}, {.storage = storage});
            const std::size_t count = storage == Storage::fixed ? even_ : inserts_.size();
            build(other, count);
            if (const std::string text = sorted_difference(other, count); !text.empty())
                return (storage == Storage::counted ? "counted, " : "fixed, ") + text;
        }
        return {};
    }

    std::string takes_the_nearest() {
        Kernel nearest(device_, selftest_source, "selftest_nearest", lists(), type<SelftestInsert>);
        build(lists(), inserts_.size());
        Buffer<SelftestRecord> out(device_, width * height * 4);
        Buffer<cl_uint> counts(device_, width * height);
        nearest.run(Range::padded(width * height), lists(), out, counts);
        const std::vector<SelftestRecord> records = out.download();
        const std::vector<cl_uint> found = counts.download();
        for (const auto& [cell, all] : oracle(inserts_.size())) {
            const std::vector<Record> expected(
                all.begin(),
                all.begin() + static_cast<std::ptrdiff_t>(std::min<std::size_t>(4, all.size())));
            std::vector<Record> got;
            for (std::size_t i = 0; i < std::min(found[cell], cl_uint{4}); ++i)
                got.emplace_back(records[cell * 4 + i].key, records[cell * 4 + i].id);
            if (const std::string text = difference(cell, expected, got); !text.empty())
                return text;
        }
        return {};
    }

    std::string drops_exactly() {
        const std::uint64_t capacity = inserts_.size() * 7 / 20 + 1;
        Lists<SelftestRecord> small(device_, {width, height},
                                    {.overflow = Overflow::drop, .capacity_nodes = capacity});
        const BuildReport report = build(small, inserts_.size());
        return first_of(
            {difference("stored", capacity, report.stored),
             difference("dropped", stored_of(inserts_.size()) - capacity, report.dropped),
             lists_state(small)});
    }

private:
    /// The lists after the first `count` inserts.
    [[nodiscard]] Oracle oracle(std::size_t count) const {
        Oracle oracle;
        for (std::size_t i = 0; i < count; ++i) {
            const SelftestInsert& insert = inserts_[i];
            if (insert.x < 0 || insert.y < 0 || insert.x >= static_cast<cl_int>(width) ||
                insert.y >= static_cast<cl_int>(height))
                continue;
            const auto cell =
                static_cast<std::uint64_t>(insert.y) * width + static_cast<std::uint64_t>(insert.x);
            oracle[cell].emplace_back(insert.record.key, insert.record.id);
        }
        for (auto& [cell, records] : oracle) std::sort(records.begin(), records.end());
        return oracle;
    }

    [[nodiscard]] std::uint64_t stored_of(std::size_t count) const {
        std::uint64_t stored = 0;
        for (const auto& [cell, records] : oracle(count)) stored += records.size();
        return stored;
    }

    /// Sorts the lists and compares them with the oracle.
    std::string sorted_difference(Lists<SelftestRecord>& lists, std::size_t count) const {
        const Oracle all = oracle(count);
        lists.sort(&SelftestRecord::key);
        const HostLists<SelftestRecord> host = lists.download();
        for (std::uint64_t cell = 0; cell < host.cells(); ++cell) {
            std::vector<Record> found;
            for (const SelftestRecord& record : host.cell(cell))
                found.emplace_back(record.key, record.id);
            const auto expected = all.find(cell);
            const std::string text = difference(
                cell, expected == all.end() ? std::vector<Record>() : expected->second, found);
            if (!text.empty()) return text;
        }
        return lists_state(lists);
    }

    Lists<SelftestRecord>& lists() {
        if (!lists_)
            lists_.emplace(device_, Shape{width, height}, ListsOptions{.capacity_nodes = 100});
        return *lists_;
    }

    /// Builds lists from the first `count` inserts.
    BuildReport build(Lists<SelftestRecord>& lists, std::size_t count) {
        if (!insert_)
            insert_.emplace(device_, selftest_source, "selftest_insert", lists,
                            type<SelftestInsert>);
        const Buffer<SelftestInsert> inserts(device_, inserts_);
        return lists.build(*insert_, Range::padded(count), inserts, static_cast<cl_uint>(count));
    }

    static std::string lists_state(const Lists<SelftestRecord>& lists) {
        const Validation validation = lists.validate();
        return validation.ok() ? std::string() : validation.message();
    }

    const Device& device_;
    std::vector<SelftestInsert> inserts_;
    std::size_t even_ = 0;  ///< inserts before those of the long list
    std::optional<Lists<SelftestRecord>> lists_;
    std::optional<Kernel> insert_;
};

}  // namespace

int selftest(const Device& device, std::ostream& out) {
    out << device.info().name << " (" << device.info().platform << ", driver "
        << device.info().driver << ")\n";
    Selftest test(device);
    const std::pair<const char*, std::function<std::string()>> checks[] = {
        {"grows to the exact demand and counts every record",
         [&] { return test.grows_and_counts(); }},
        {"sorts every list, ties included", [&] { return test.sorts(); }},
        {"finds the 4 nearest records of every list", [&] { return test.takes_the_nearest(); }},
        {"fills contiguous lists and fixed slots", [&] { return test.fills_other_storages(); }},
        {"drops exactly the records that do not fit", [&] { return test.drops_exactly(); }},
    };
    bool all_passed = true;
    for (const auto& [name, check] : checks) {
        std::string difference;
        try {
            difference = check();
        } catch (const Error& error) {
            difference = error.what();
        }
        out << (difference.empty() ? "  ok      " : "  FAILED  ") << name << '\n';
        if (!difference.empty()) out << "          " << difference << '\n';
        all_passed = all_passed && difference.empty();
    }
    out << (all_passed ? "cellist works on this device\n"
                       : "cellist does not work on this device\n");
    return all_passed ? 0 : 1;
}

}  // namespace cellist::command
