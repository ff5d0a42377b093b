// SPDX-License-Identifier: MIT
// A sort that has no memory for some of its buffers sorts every list all the same.
#include "support/inserts.hpp"
#include "support/storages.hpp"

namespace cellist::test {
namespace {

TEST_CASE("short and long lists are sorted, whichever buffers the budget has room for") {
    constexpr cl_uint cells = 501;
    constexpr std::uint64_t capacity = 20'000;
    CELLIST_EACH_STORAGE(storage);
    if (has_slots(storage)) return;
    CELLIST_RANDOM(random, 77u);
    Inserts<Item> inserts = random_inserts(10'000, cells, random);
    for (std::size_t i = 0; i < 2000; ++i) inserts.cells[i] = 7;
    const auto key = [](const Item& item) { return item.id ^ 0x2AAAu; };
    std::optional<std::uint64_t> pool_bytes;
    // The second pool takes 16 bytes a node at most, and keys as many.
    for (std::uint64_t extra = 0; extra <= 40 * capacity; extra += 2 * capacity) {
        ListsOptions options{.storage = storage, .capacity_nodes = capacity};
        if (pool_bytes) options.budget_bytes = *pool_bytes + extra;
        Lists<Item> lists(device(), {cells}, options);
        Inserter(lists).build(lists, inserts);
        if (!pool_bytes) pool_bytes = lists.pool_bytes();
        lists.sort_by("record.id ^ 0x2AAAu");
        const HostLists<Item> found = lists.download();
        require_same(found, oracle_of(inserts, cells));
        INFO("budget of " << extra << " bytes over the pool");
        for (std::uint64_t cell = 0; cell < cells; ++cell)
            REQUIRE(std::is_sorted(found.cell(cell).begin(), found.cell(cell).end(),
                                   [&](const Item& a, const Item& b) { return key(a) < key(b); }));
    }
}

}  // namespace
}  // namespace cellist::test
