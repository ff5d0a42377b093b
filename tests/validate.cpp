// SPDX-License-Identifier: MIT
// validate() accepts sound lists and finds every kind of corruption, without hanging or crashing.
#include "support/errors.hpp"
#include "support/inserts.hpp"

namespace cellist::test {
namespace {

constexpr auto corrupt_linked_source = R"(
#include <cellist/lists.clh>

static uint last_of(CELLIST_LISTS(Item, lists), uint cell)
{
    uint last = lists_heads[cell];
    cellist_for_each(lists, cell, node) last = node;
    return last;
}

kernel void set_head(CELLIST_LISTS(Item, lists), uint cell, uint head)
{
    lists_heads[cell] = head;
}
kernel void set_second(CELLIST_LISTS(Item, lists), uint cell, uint node)
{
    lists_nodes[lists_heads[cell]].next = node;
}
kernel void self_cycle(CELLIST_LISTS(Item, lists), uint cell)
{
    const uint first = lists_heads[cell];
    lists_nodes[first].next = first;
}
kernel void long_cycle(CELLIST_LISTS(Item, lists), uint cell)
{
    lists_nodes[last_of(CELLIST_PASS(lists), cell)].next = lists_heads[cell];
}
kernel void share_tail(CELLIST_LISTS(Item, lists), uint cell, uint other)
{
    lists_nodes[last_of(CELLIST_PASS(lists), cell)].next =
        lists_nodes[lists_heads[other]].next;
}
kernel void share_head(CELLIST_LISTS(Item, lists), uint cell, uint other)
{
    lists_heads[cell] = lists_heads[other];
}
kernel void scramble(CELLIST_LISTS(Item, lists), uint seed, uint range)
{
    const uint node = get_global_id(0);
    lists_nodes[node].next = (node * 2654435761u + seed) % range;
    if (node < cellist_cells(lists)) lists_heads[node] = (node * 40503u + seed) % range;
}
)";

class LinkedCorruption {
public:
    static constexpr cl_uint cells = 10;
    static constexpr cl_uint length = 30;  ///< nodes of each list
    static constexpr cl_uint capacity = 5000;

    LinkedCorruption() : lists(device(), {cells}, {.capacity_nodes = capacity}), inserter_(lists) {
        for (cl_uint i = 0; i < cells * length; ++i)
            inserts_.add(i % cells, {static_cast<cl_float>(i), i});
        restore();
    }

    void restore() {
        inserter_.build(lists, inserts_);
        require_sound(lists, cells * length);
    }

    template <class... Args>
    Validation after(const std::string& kernel, const Range& range, const Args&... args) {
        Kernel(device(), corrupt_linked_source, kernel, lists).run(range, lists, args...);
        const Validation validation = lists.validate();
        REQUIRE_FALSE(validation.ok());
        return validation;
    }

    Lists<Item> lists;

private:
    Inserts<Item> inserts_;
    Inserter<Item> inserter_;
};

void require_findings(const Validation& found, std::uint64_t broken, std::uint64_t repeated,
                      std::uint64_t lost) {
    INFO(found.message());
    REQUIRE(found.broken_links == broken);
    REQUIRE(found.repeated_nodes == repeated);
    REQUIRE(found.lost_nodes == lost);
}

TEST_CASE("a link that leads out of the pool is found") {
    LinkedCorruption corruption;
    for (const cl_uint node : {5000u, 5001u, 0x7FFFFFFFu, 0x80000000u, 0xFFFFFFFEu}) {
        INFO("node " << node);
        const Validation found = corruption.after("set_second", 1, cl_uint{6}, node);
        require_findings(found, 1, 0, 29);
        REQUIRE(found.first_bad_cell == 6);
        REQUIRE(contains(found.message(), "cell 6"));
    }
    corruption.restore();
}

TEST_CASE("a head that leads out of the pool is found") {
    LinkedCorruption corruption;
    for (const cl_uint node : {5000u, 0x12345678u, 0xFFFFFFFEu}) {
        INFO("node " << node);
        const Validation found = corruption.after("set_head", 1, cl_uint{3}, node);
        require_findings(found, 1, 0, 30);
        REQUIRE(found.first_bad_cell == 3);
    }
}

TEST_CASE("links and heads that lead to a node that was never allocated are found") {
    LinkedCorruption corruption;
    require_findings(corruption.after("set_second", 1, cl_uint{9}, cl_uint{4999}), 1, 0, 29);
    require_findings(corruption.after("set_head", 1, cl_uint{2}, cl_uint{4998}), 2, 0, 29 + 30);
    REQUIRE(corruption.lists.validate().first_bad_cell == 2);
}

TEST_CASE("a node that links to itself is found") {
    LinkedCorruption corruption;
    const Validation found = corruption.after("self_cycle", 1, cl_uint{4});
    require_findings(found, 0, 1, 29);
    REQUIRE(found.first_bad_cell == 4);
}

TEST_CASE("a list that ends in its own first node is found") {
    LinkedCorruption corruption;
    const Validation found = corruption.after("long_cycle", 1, cl_uint{0});
    require_findings(found, 0, 1, 0);
    REQUIRE(found.first_bad_cell == 0);
}

TEST_CASE("two lists that share their tail are found") {
    LinkedCorruption corruption;
    const Validation found = corruption.after("share_tail", 1, cl_uint{7}, cl_uint{5});
    require_findings(found, 0, 1, 0);
    REQUIRE((found.first_bad_cell == 7 || found.first_bad_cell == 5));
}

TEST_CASE("two heads that lead to one list are found") {
    LinkedCorruption corruption;
    const Validation found = corruption.after("share_head", 1, cl_uint{8}, cl_uint{1});
    require_findings(found, 0, 1, 30);
    REQUIRE((found.first_bad_cell == 8 || found.first_bad_cell == 1));
}

TEST_CASE("nodes that no head leads to are found") {
    LinkedCorruption corruption;
    require_findings(corruption.after("set_head", 1, cl_uint{3}, cl_uint{0xFFFFFFFFu}), 0, 0, 30);
    require_findings(corruption.after("set_second", 1, cl_uint{4}, cl_uint{0xFFFFFFFFu}), 0, 0, 59);
}

TEST_CASE("scrambled heads and links are found and end") {
    LinkedCorruption corruption;
    for (cl_uint seed = 0; seed < 20; ++seed)
        for (const cl_uint range : {1u, 300u, 5000u, 10'000u, 0xFFFFFFFFu}) {
            INFO("seed " << seed << ", range " << range);
            const Validation found =
                corruption.after("scramble", LinkedCorruption::capacity, seed, range);
            // Each walk ends at its first bad link.
            REQUIRE(found.broken_links + found.repeated_nodes <= LinkedCorruption::cells);
            REQUIRE(found.lost_nodes <= LinkedCorruption::cells * LinkedCorruption::length);
        }
    corruption.restore();
}

TEST_CASE("containers without cells, nodes or records are sound") {
    for (const Shape& shape : {Shape{0}, Shape{1}, Shape{100}})
        for (const std::uint64_t capacity : {0u, 1u, 33u, 5000u}) {
            const Validation found =
                Lists<Item>(device(), shape, {.capacity_nodes = capacity}).validate();
            require_findings(found, 0, 0, 0);
            REQUIRE(found.ok());
            REQUIRE_FALSE(found.message().empty());
        }
}

}  // namespace
}  // namespace cellist::test
