// SPDX-License-Identifier: MIT
#pragma once
// What results must be. There is no INFO in these: it would outlive each OpenCL error that passes
// it.

#include <cstdint>
#include <vector>

#include "scene.hpp"

namespace cellist::test {

void require_all_stored(const BuildReport& report, const Oracle<Item>& oracle);
void require_lengths(const Lengths& lengths, const Oracle<Item>& oracle);
void require_packed(const Packed<Item>& packed, const Oracle<Item>& oracle);
void require_packed_ids(const Packed<cl_uint>& packed, const Oracle<Item>& oracle);
void require_sound(const Validation& validation);
void require(Contents contents, const Lists<Item>& lists, const Oracle<Item>& oracle);

/// Downloads while no call fails.
HostLists<Item> contents_of(const Lists<Item>& lists);

/// Whether an item comes before another one.
using Before = bool (*)(const Item&, const Item&);
bool by_key(const Item& a, const Item& b);
bool by_id(const Item& a, const Item& b);

/// The items of a cell, sorted.
std::vector<Item> in_order(const Oracle<Item>& oracle, std::uint64_t cell, Before before);
void require_sorted(const HostLists<Item>& found, const Oracle<Item>& oracle, Before before);

}  // namespace cellist::test
