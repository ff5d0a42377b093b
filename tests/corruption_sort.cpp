// SPDX-License-Identifier: MIT
// Sorting lists whose links or offsets no build makes: it ends, writes nothing outside of the pool,
// and says so where it finds out.
#include <iostream>

#include "support/errors.hpp"
#include "support/internals.hpp"
#include "support/sorted.hpp"

namespace cellist::test {
namespace {

constexpr auto corrupt_sort_source = R"(
#include <cellist/lists.clh>

// Every head and every link leads anywhere below `range`, or nowhere.
kernel void scramble_links(CELLIST_LISTS(Item, lists), uint seed, uint range, uint nodes)
{
    const uint i = get_global_id(0);
    const uint hash = (i * 2654435761u + seed * 40503u) ^ (i * 2246822519u >> 7);
    const uint target = hash % 5u == 0u ? CELLIST_NONE : hash % range;
    if (i < cellist_cells(lists)) lists_heads[i] = target;
    if (i < nodes) lists_nodes[i].next = hash % range;
}

// All lists begin with one node, whose links lead in a circle of `length` nodes.
kernel void make_circle(CELLIST_LISTS(Item, lists), uint length)
{
    const uint i = get_global_id(0);
    if (i < cellist_cells(lists)) lists_heads[i] = 0;
    if (i < length) lists_nodes[i].next = (i + 1u) % length;
}

// The first node of a cell leads to the first of cell `target`, or to node `target` where there is
// no such cell.
kernel void cut(CELLIST_LISTS(Item, lists), uint cell, uint target)
{
    lists_nodes[lists_heads[cell]].next =
        target < cellist_cells(lists) ? lists_heads[target] : target;
}

kernel void scramble_offsets(CELLIST_LISTS(Item, lists), uint seed, uint range)
{
    const uint i = get_global_id(0);
    if (i > cellist_cells(lists)) return;
    lists_heads[i] = seed == 0u ? i % 2u * range : (i * 2654435761u + seed * 40503u) % (range + 40u);
}
)";

struct Corrupt {
    static constexpr cl_uint cells = 40;
    static constexpr cl_uint nodes = 1200;

    Corrupt(Storage storage, cl_device_type division)
        : lists(device(), {cells}, {.storage = storage, .capacity_nodes = nodes}),
          inserter_(lists) {
        std::mt19937 random(180);
        inserts_ = random_inserts(nodes, cells, random);
        sort_as_on(lists, division);
    }

    void restore() { inserter_.build(lists, inserts_); }

    /// Sorts, whatever comes of it, and returns whether that is an error.
    bool sort_fails(bool partial = false) {
        device().finish();
        try {
            if (partial)
                lists.partial_sort(&Item::key, 2);
            else
                lists.sort(&Item::key);
        } catch (const OpenClError&) {
            throw;
        } catch (const Error& error) {
            REQUIRE(contains(error.what(), "cannot be sorted"));
            return true;
        }
        device().finish();
        return false;
    }

    /// Sound lists are built and sorted as if nothing had been.
    void require_usable() {
        restore();
        lists.sort(&Item::key);
        require_sound(lists, nodes);
        require_sorted(lists.download(), oracle_of(inserts_, cells), by_key);
    }

    Lists<Item> lists;

private:
    Inserter<Item> inserter_;
    Inserts<Item> inserts_;
};

#define CELLIST_ANY_DIVISION                                                                       \
    GENERATE(cl_device_type{CL_DEVICE_TYPE_CPU}, cl_device_type{CL_DEVICE_TYPE_GPU})

TEST_CASE("links in circles and links that meet do not sort", "[corruption]") {
    Corrupt corrupt(Storage::linked, CELLIST_ANY_DIVISION);
    Kernel scramble(device(), corrupt_sort_source, "scramble_links", corrupt.lists);
    cl_uint failed = 0;
    constexpr cl_uint tried = 60;
    for (cl_uint seed = 0; seed < tried; ++seed) {
        INFO("seed " << seed);
        corrupt.restore();
        scramble.run(Range::padded(Corrupt::nodes, 64), corrupt.lists, seed,
                     seed % 3 == 0 ? 20u : Corrupt::nodes, Corrupt::nodes);
        if (corrupt.sort_fails())
            ++failed;
        else
            REQUIRE(corrupt.lists.validate().lost_nodes == 0);
    }
    REQUIRE(failed == tried);
    corrupt.require_usable();
    std::cout << "corruption: " << tried << " scrambled linked lists sorted\n";
}

TEST_CASE("all lists in one circle do not sort", "[corruption][oclgrind]") {
    Corrupt corrupt(Storage::linked, CELLIST_ANY_DIVISION);
    Kernel make_circle(device(), corrupt_sort_source, "make_circle", corrupt.lists);
    for (const cl_uint length : {1u, 2u, 3u, 16u, 257u, 600u, Corrupt::nodes}) {
        INFO("a circle of " << length);
        corrupt.restore();
        make_circle.run(Range::padded(Corrupt::nodes, 64), corrupt.lists, length);
        REQUIRE(corrupt.sort_fails());
        REQUIRE_FALSE(corrupt.lists.validate().ok());
    }
    corrupt.require_usable();
}

TEST_CASE("links out of the pool and lists of other lengths do not sort", "[corruption]") {
    Corrupt corrupt(Storage::linked, CELLIST_ANY_DIVISION);
    Kernel cut(device(), corrupt_sort_source, "cut", corrupt.lists);
    // Out of the pool; nowhere, so that nodes are lost; to another list, whose end two lists share
    // then.
    for (const cl_uint target : {0x7FFFFFFFu, 0xFFFFFFFEu, 0xFFFFFFFFu, 5u})
        for (const bool partial : {false, true}) {
            INFO("a link to " << target);
            corrupt.restore();
            cut.run(1, corrupt.lists, 3u, target);
            REQUIRE(corrupt.sort_fails(partial));
        }
    corrupt.require_usable();
}

TEST_CASE("offsets that descend are an error of a sort", "[corruption]") {
    Corrupt corrupt(Storage::counted, CELLIST_ANY_DIVISION);
    Kernel scramble(device(), corrupt_sort_source, "scramble_offsets", corrupt.lists);
    scramble.run(Range::padded(Corrupt::cells + 1, 64), corrupt.lists, 0u, Corrupt::nodes);
    REQUIRE(corrupt.sort_fails());
    corrupt.require_usable();
}

TEST_CASE("impossible offsets end a sort, too", "[corruption]") {
    Corrupt corrupt(Storage::counted, CELLIST_ANY_DIVISION);
    Kernel scramble(device(), corrupt_sort_source, "scramble_offsets", corrupt.lists);
    constexpr cl_uint tried = 40;
    for (cl_uint seed = 0; seed < tried; ++seed) {
        INFO("seed " << seed);
        corrupt.restore();
        scramble.run(Range::padded(Corrupt::cells + 1, 64), corrupt.lists, seed, Corrupt::nodes);
        corrupt.sort_fails();
        REQUIRE_FALSE(corrupt.lists.validate().ok());
    }
    corrupt.require_usable();
    std::cout << "corruption: " << tried << " scrambled offsets sorted\n";
}

TEST_CASE("lengths of links in circles end", "[corruption]") {
    Corrupt corrupt(Storage::linked, CL_DEVICE_TYPE_CPU);
    Kernel make_circle(device(), corrupt_sort_source, "make_circle", corrupt.lists);
    corrupt.restore();
    make_circle.run(Range::padded(Corrupt::nodes, 64), corrupt.lists, 7u);
    REQUIRE(corrupt.lists.lengths().longest == Corrupt::nodes);
}

}  // namespace
}  // namespace cellist::test
