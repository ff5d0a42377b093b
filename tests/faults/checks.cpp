// SPDX-License-Identifier: MIT
#include "checks.hpp"

#include <algorithm>
#include <map>

#include "layer.hpp"

namespace cellist::test {

void require_all_stored(const BuildReport& report, const Oracle<Item>& oracle) {
    require_complete(report, oracle.size(), insert_count - oracle.size());
}

bool by_key(const Item& a, const Item& b) { return a.key != b.key ? a.key < b.key : a.id < b.id; }
bool by_id(const Item& a, const Item& b) { return a.id < b.id; }

std::vector<Item> in_order(const Oracle<Item>& oracle, std::uint64_t cell, Before before) {
    std::vector<Item> list;
    const auto [begin, end] = oracle.equal_range(cell);
    for (auto entry = begin; entry != end; ++entry) list.push_back(entry->second);
    std::sort(list.begin(), list.end(), before);
    return list;
}

void require_sorted(const HostLists<Item>& found, const Oracle<Item>& oracle, Before before) {
    for (std::uint64_t cell = 0; cell < cell_count; ++cell) {
        const auto list = found.cell(cell);
        const std::vector<Item> expected = in_order(oracle, cell, before);
        REQUIRE(std::equal(list.begin(), list.end(), expected.begin(), expected.end()));
    }
}

void require_packed(const Packed<Item>& packed, const Oracle<Item>& oracle) {
    const faults::Pause pause;
    std::vector<std::uint64_t> offsets;
    for (const cl_uint offset : packed.offsets.download()) offsets.push_back(offset);
    REQUIRE(offsets.size() == cell_count + 1);
    require_same(HostLists<Item>({cell_count}, std::move(offsets), packed.records.download()),
                 oracle);
}

void require_packed_ids(const Packed<cl_uint>& packed, const Oracle<Item>& oracle) {
    const faults::Pause pause;
    std::vector<cl_uint> found = packed.records.download();
    std::vector<cl_uint> expected;
    for (const auto& [cell, item] : oracle) expected.push_back(item.id);
    std::sort(found.begin(), found.end());
    std::sort(expected.begin(), expected.end());
    REQUIRE(found == expected);
}

void require_lengths(const Lengths& lengths, const Oracle<Item>& oracle) {
    std::map<std::uint64_t, std::uint64_t> histogram;
    for (std::uint64_t cell = 0; cell < cell_count; ++cell) ++histogram[oracle.count(cell)];
    REQUIRE(lengths.histogram == histogram);
    REQUIRE(lengths.total == oracle.size());
    REQUIRE(lengths.longest == histogram.rbegin()->first);
}

void require_sound(const Validation& validation) {
    if (!validation.ok()) FAIL(validation.message());
}

void require(Contents contents, const Lists<Item>& lists, const Oracle<Item>& oracle) {
    const faults::Pause pause;
    require_sound(lists.validate());
    require_same(lists.download(), contents == Contents::full ? oracle : Oracle<Item>());
}

HostLists<Item> contents_of(const Lists<Item>& lists) {
    const faults::Pause pause;
    return lists.download();
}

}  // namespace cellist::test
