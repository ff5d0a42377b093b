// SPDX-License-Identifier: MIT
// A sort by an expression whose value changes from call to call loses no record, and neither does
// any class of lists.
#include "support/inserts.hpp"
#include "support/internals.hpp"
#include "support/storages.hpp"

namespace cellist::test {
namespace {

/// Other values in every kernel, work-item and list.
constexpr auto no_order = "((uint)get_global_id(0) + 7u) * 2654435761u * (record.id | 1u)";

/// Sorts lists of these lengths, on each storage and as on each device.
void require_all_records(const std::vector<cl_uint>& lengths) {
    CELLIST_EACH_STORAGE(storage);
    CELLIST_RANDOM(random, 270u);
    const auto division =
        GENERATE(cl_device_type{CL_DEVICE_TYPE_CPU}, cl_device_type{CL_DEVICE_TYPE_GPU});
    Inserts<Item> inserts;
    for (const cl_uint length : lengths)
        for (cl_uint i = 0; i < length; ++i)
            inserts.add(length % 13,
                        {static_cast<cl_float>(i), static_cast<cl_uint>(inserts.size())});
    inserts.shuffle(random);
    const Oracle<Item> oracle = oracle_of(inserts, 13);
    Lists<Item> lists(device(), {13}, {.storage = storage});
    sort_as_on(lists, division);
    Inserter(lists).build(lists, inserts);
    for (const bool descending : {false, true}) {
        const Order order = descending ? Order::descending : Order::ascending;
        lists.sort_by(no_order, order);
        require_sound(lists, inserts.size());
        require_same(lists.download(), oracle);
        lists.partial_sort_by(no_order, 2, order);
        require_same(lists.download(), oracle);
        lists.sort_by_async(no_order, order);
        require_sound(lists, inserts.size());
        require_same(lists.download(), oracle);
    }
}

TEST_CASE("a sort by what is no order loses no record") {
    require_all_records({0, 3, 40, 200, 2500});
}

// The longest list still has several chunks, and an odd one, on each device.
TEST_CASE("a sort by what is no order loses no record of shorter lists", "[oclgrind]") {
    require_all_records({0, 3, 40, 200, 600});
}

}  // namespace
}  // namespace cellist::test
