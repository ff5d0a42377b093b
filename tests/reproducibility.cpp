// SPDX-License-Identifier: MIT
// The sorted lists depend on what was inserted, not on when: downloads are equal bit for bit.
#include <bit>
#include <iostream>

#include "support/sorted.hpp"
#include "support/storages.hpp"

namespace cellist::test {
namespace {

constexpr int permutations = 50;

TEST_CASE("sorted downloads are bit-identical over permutations of the input and storages",
          "[reproducibility]") {
    CELLIST_RANDOM(random, 90u);
    Inserts<Item> inserts = random_inserts(20'000, 200, random);
    for (std::size_t i = 0; i < inserts.size(); ++i) {
        Item& item = inserts.records[i];
        if (i % 3 == 0) item.key = 1.0f;
        if (i % 100 == 1) item.key = std::bit_cast<cl_float>(0x7FC00000u + below(random, 3));
        if (i % 100 == 2) item.key = std::bit_cast<cl_float>(0x80000000u * below(random, 2));
        if (i % 7 == 0) item.id = 5;
    }
    std::optional<HostLists<Item>> first;
    int downloads = 0;
    for (int permutation = 0; permutation < permutations; ++permutation) {
        for (const Storage storage : all_storages) {
            INFO("permutation " << permutation << ", storage " << name_of(storage));
            Lists<Item> lists(device(), {20, 10},
                              {.storage = storage,
                               .capacity_nodes = 1u + below(random, 30'000),
                               .slots = below(random, 300)});
            Inserter(lists).build(lists, inserts);
            lists.sort(&Item::key);
            const HostLists<Item> found = lists.download();
            if (!first) {
                first = found;
                require_same(found, oracle_of(inserts, 200));
            }
            REQUIRE(same_bits(*first, found));
            ++downloads;
            if (permutation != 0) continue;
            lists.sort(&Item::key);
            REQUIRE(same_bits(*first, lists.download()));
        }
        inserts.shuffle(random);
    }
    std::cout << "reproducibility: " << downloads << " equal downloads of " << permutations
              << " permutations" << std::endl;
}

}  // namespace
}  // namespace cellist::test
