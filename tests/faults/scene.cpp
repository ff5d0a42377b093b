// SPDX-License-Identifier: MIT
#include "scene.hpp"

#include <algorithm>

#include "checks.hpp"
#include "layer.hpp"
#include "support/internals.hpp"
#include "support/storages.hpp"

namespace cellist::test {
namespace {

// No #include: it would only be searched for.
constexpr auto source = R"(
kernel void insert(CELLIST_LISTS(Item, lists), global const uint* cells, global const Item* records,
                   uint count)
{
    const uint i = get_global_id(0);
    if (i < count) cellist_insert(lists, cells[i], records[i]);
}

kernel void insert_both(CELLIST_LISTS(Item, a), CELLIST_LISTS(Item, b), global const uint* cells,
                        global const Item* records, uint count)
{
    const uint i = get_global_id(0);
    if (i >= count) return;
    cellist_insert(a, cells[i], records[i]);
    cellist_insert(b, cells[i], records[i]);
}

// The number of records in each cell and the sum of their ids.
kernel void read(CELLIST_LISTS(Item, lists), global uint2* sums)
{
    const uint cell = get_global_id(0);
    if (cell >= cellist_cells(lists)) return;
    uint2 sum = 0;
    cellist_for_each(lists, cell, node) sum += (uint2)(1, cellist_get(lists, node).id);
    sums[cell] = sum;
}
)";

Storage next(Storage storage) {
    const auto found = std::find(all_storages.begin(), all_storages.end(), storage);
    return found + 1 == all_storages.end() ? all_storages.front() : *(found + 1);
}

}  // namespace

std::string_view scene_source() { return source; }

Range insert_range() { return Range::padded(insert_count, 32); }

ListsOptions scene_options(const Device& device, Storage storage, Room room, Overflow overflow,
                           Kind kind) {
    ListsOptions options{.storage = storage, .overflow = overflow};
    if (kind == Kind::automatic) options.storage = Storage::automatic;
    if (kind == Kind::nearest) options.storage = nearest(&Item::key, insert_count);
    options.capacity_nodes = room == Room::enough       ? 2 * insert_count
                             : room == Room::too_little ? insert_count / 3
                                                        : 0;
    options.slots = room == Room::enough ? insert_count : room == Room::too_little ? 1 : 0;
    if (room == Room::for_a_part)
        options.budget_bytes = Lists<Item>(device, {cell_count}, options).pool_bytes() + 600;
    return options;
}

Inserts<Item> scene_inserts() {
    std::mt19937 random(301);
    Inserts<Item> inserts = random_inserts(insert_count, cell_count, random);
    std::fill_n(inserts.cells.begin(), 3, cell_count);
    return inserts;
}

Scene::Scene(const Device& on, Storage storage, const Operation& operation)
    : device(on),
      options(scene_options(on, storage, operation.room, operation.overflow, operation.kind)),
      inserts(scene_inserts()),
      oracle(oracle_of(inserts, cell_count)),
      cells(on, inserts.cells),
      records(on, inserts.records),
      lists(on, {cell_count}, options),
      other(on, {cell_count}, scene_options(on, next(storage), operation.room, operation.overflow)),
      insert(on, source, "insert", lists),
      insert_both(on, source, "insert_both", lists, other),
      read(on, source, "read", lists) {
    if (operation.kind == Kind::automatic)
        while (tuner_of(lists)->storage() != storage)
            tuner_of(lists)->measured({{1e-3, 1e-3}, oracle.size(), 10});
    if (operation.before == Contents::full) build();
    if (operation.use == Use::repeated) operation.run(*this);
}

void Scene::build() {
    lists_hold = Contents::empty;
    const BuildReport report = lists.build(insert, insert_range(), cells, records, insert_count);
    lists_hold = Contents::full;
    require_all_stored(report, oracle);
}

void Scene::forgive_missing_memory() {
    const std::vector<faults::Fault> failures = faults::failures();
    silent = !failures.empty() && std::ranges::all_of(failures, &faults::Fault::lacks_memory);
}

void Scene::require_contents() const {
    require(lists_hold, lists, oracle);
    if (uses_other) require(other_holds, other, oracle);
}

}  // namespace cellist::test
