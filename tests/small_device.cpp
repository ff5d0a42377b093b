// SPDX-License-Identifier: MIT
// What sorts, packs and validates takes its sizes from the device: one with small work-groups and
// little local memory.
#include "device/device_state.hpp"
#include "support/inserts.hpp"
#include "support/internals.hpp"
#include "support/sorted.hpp"
#include "support/storages.hpp"

namespace cellist::test {
namespace {

TEST_CASE("small work-groups sort, pack and validate") {
    const Device small = Device::choose();
    DeviceInfo& info = small.state()->info;
    info.max_work_group_size = 64;
    info.local_memory_bytes = 32768;
    info.max_allocation_bytes = 1 << 20;
    CELLIST_EACH_STORAGE(storage);
    CELLIST_RANDOM(random, 290u);
    Inserts<Item> inserts = random_inserts(3000, 5000, random);
    for (cl_uint i = 0; i < 700; ++i)
        inserts.add(i % 7 < 5 ? 17 : 4000, {static_cast<cl_float>(i % 50), 3000 + i});
    ListsOptions options{.storage = storage};
    if (has_slots(storage)) options.slots = 10;
    if (has_slots(storage)) inserts = random_inserts(3000, 5000, random);
    Lists<Item> lists(small, {5000}, options);
    sort_as_on(lists, CL_DEVICE_TYPE_GPU);
    const Oracle<Item> oracle = oracle_of(inserts, 5000);
    require_complete(Inserter(lists, small).build(lists, inserts), oracle.size());
    lists.sort(&Item::key);
    require_sound(lists, oracle.size());
    require_sorted(lists.download(), oracle, by_key);
    REQUIRE(lists.pack().records.size() == oracle.size());
}

}  // namespace
}  // namespace cellist::test
