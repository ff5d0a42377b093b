// lengths() describes the lists as the oracle does.
#include "support/inserts.hpp"
#include "support/storages.hpp"

namespace cellist::test {
namespace {

void check(Storage storage, const Shape& shape, const Inserts<Item>& inserts) {
    INFO("shape " << shape.to_string() << ", " << inserts.size() << " inserts");
    Lists<Item> lists(device(), shape, {.storage = storage});
    Inserter(lists).build(lists, inserts);
    const Oracle<Item> oracle = oracle_of(inserts, shape.cells());
    std::map<std::uint64_t, std::uint64_t> cells_of_length;
    for (std::uint64_t cell = 0; cell < shape.cells(); ++cell)
        ++cells_of_length[oracle.count(cell)];
    const std::uint64_t longest = cells_of_length.empty() ? 0 : cells_of_length.rbegin()->first;

    const Lengths lengths = lists.lengths();
    REQUIRE(lengths.total == oracle.size());
    REQUIRE(lengths.longest == longest);
    REQUIRE(lengths.nonempty_cells == shape.cells() - cells_of_length[0]);
    std::erase_if(cells_of_length, [](const auto& entry) { return entry.second == 0; });
    REQUIRE(lengths.histogram == cells_of_length);
}

TEST_CASE("the histogram counts the cells of every length") {
    CELLIST_EACH_STORAGE(storage);
    CELLIST_RANDOM(random, 120u);
    for (const std::size_t count : {0u, 1u, 7u, 93u, 144u, 4096u}) {
        check(storage, {13, 11}, random_inserts(count, 150, random));
        check(storage, {1}, random_inserts(count, 1, random));
        check(storage, {0}, random_inserts(count, 1, random));
    }
    Inserts<Item> one_long = random_inserts(4096, 1, random);
    for (cl_uint& cell : one_long.cells) cell = 42;
    check(storage, {13, 11}, one_long);
}

}  // namespace
}  // namespace cellist::test
