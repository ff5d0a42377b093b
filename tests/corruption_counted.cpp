// SPDX-License-Identifier: MIT
// validate() finds offsets and counts of Storage::counted that do not belong together.
#include <iostream>

#include "support/inserts.hpp"
#include "support/storages.hpp"

namespace cellist::test {
namespace {

constexpr auto corrupt_counted_source = R"(
#include <cellist/lists.clh>

// heads are cells + 1 offsets, then a count for each cell.
kernel void set_word(CELLIST_LISTS(Item, lists), uint word, uint value)
{
    lists_heads[word] = value;
}
kernel void scramble(CELLIST_LISTS(Item, lists), uint seed, uint range)
{
    const uint word = get_global_id(0);
    lists_heads[word] = (word * 2654435761u + seed * 40503u) % range;
}
)";

class CountedCorruption {
public:
    static constexpr cl_uint cells = 10;
    static constexpr cl_uint length = 30;  ///< nodes of each list
    static constexpr cl_uint capacity = 400;
    static constexpr cl_uint counts_at = cells + 1;

    CountedCorruption()
        : lists(device(), {cells}, {.storage = Storage::counted, .capacity_nodes = capacity}),
          inserter_(lists),
          set_(device(), corrupt_counted_source, "set_word", lists),
          scramble_(device(), corrupt_counted_source, "scramble", lists) {
        for (cl_uint i = 0; i < cells * length; ++i)
            inserts_.add(i % cells, {static_cast<cl_float>(i), i});
        restore();
    }

    void restore() {
        inserter_.build(lists, inserts_);
        require_sound(lists, cells * length);
    }

    /// What the word holds in sound lists.
    [[nodiscard]] static cl_uint sound(cl_uint word) {
        return word < counts_at ? word * length : length;
    }

    void set(cl_uint word, cl_uint value) { set_.run(1, lists, word, value); }
    void scramble(cl_uint seed, cl_uint range) { scramble_.run(2 * cells + 1, lists, seed, range); }

    /// Sets one word at a time, requires that it is found, and sets it right again.
    void require_found(cl_uint word, const std::vector<cl_uint>& values) {
        for (const cl_uint value : values) {
            if (value == sound(word)) continue;
            INFO("word " << word << " set from " << sound(word) << " to " << value);
            set(word, value);
            REQUIRE_FALSE(lists.validate().ok());
            REQUIRE_FALSE(lists.validate().message().empty());
            set(word, sound(word));
            ++tried;
        }
        REQUIRE(lists.validate().ok());
    }

    Lists<Item> lists;
    int tried = 0;

private:
    Inserts<Item> inserts_;
    Inserter<Item> inserter_;
    Kernel set_;
    Kernel scramble_;
};

TEST_CASE("offsets that are out of order or beyond the pool are found", "[corruption]") {
    CountedCorruption corruption;
    for (cl_uint word = 1; word < CountedCorruption::cells; ++word)
        corruption.require_found(
            word, {0, 1, CountedCorruption::sound(word) - 1, CountedCorruption::sound(word) + 1,
                   CountedCorruption::sound(word - 1), CountedCorruption::sound(word + 1), 300, 399,
                   400, 401, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFE, 0xFFFFFFFF});
    corruption.require_found(0, {301, 400, 401, 0x80000000, 0xFFFFFFFF});
    corruption.require_found(CountedCorruption::cells,
                             {0, 269, 301, 400, 401, 0x80000000, 0xFFFFFFFF});
    std::cout << "corruption: " << corruption.tried << " offsets of counted lists" << std::endl;
}

TEST_CASE("the findings name the first bad cell", "[corruption]") {
    CountedCorruption corruption;
    corruption.set(CountedCorruption::counts_at + 7, 29);
    Validation found = corruption.lists.validate();
    REQUIRE(found.lost_nodes > 0);
    REQUIRE(found.first_bad_cell == 7);
    corruption.set(4, 0);
    found = corruption.lists.validate();
    REQUIRE(found.broken_links > 0);
    REQUIRE(found.first_bad_cell == 3);
}

TEST_CASE("counts that are too small are found", "[corruption]") {
    CountedCorruption corruption;
    for (cl_uint cell = 0; cell < CountedCorruption::cells; ++cell)
        corruption.require_found(CountedCorruption::counts_at + cell, {0, 1, 29});
}

TEST_CASE("counts that are too large are found", "[corruption]") {
    CountedCorruption corruption;
    for (cl_uint cell = 0; cell < CountedCorruption::cells; ++cell)
        corruption.require_found(CountedCorruption::counts_at + cell,
                                 {31, 300, 0x80000000, 0xFFFFFFFF});
}

TEST_CASE("a first list that begins behind the pool's begin is found", "[corruption]") {
    CountedCorruption corruption;
    corruption.require_found(0, {1, 29, 30});
}

TEST_CASE("a last list that ends too early is found", "[corruption]") {
    CountedCorruption corruption;
    corruption.require_found(CountedCorruption::cells, {299, 271, 270});
}

TEST_CASE("a border that moves between two lists is found, dropped records or not",
          "[corruption]") {
    for (const cl_uint capacity : {75u, 100u}) {
        // Lists of 10: of 75 nodes, cell 7 has 5, and cells 8 and 9 have none.
        Lists<Item> lists(
            device(), {10},
            {.storage = Storage::counted, .overflow = Overflow::drop, .capacity_nodes = capacity});
        Inserts<Item> inserts;
        for (cl_uint i = 0; i < 100; ++i) inserts.add(i % 10, {1.0f, i});
        Inserter(lists).build(lists, inserts);
        Kernel set(device(), corrupt_counted_source, "set_word", lists);
        for (cl_uint word = 0; word <= 10; ++word)
            for (cl_uint bit = 0; bit < 32; ++bit) {
                const cl_uint sound = std::min(word * 10, capacity);
                INFO("bit " << bit << " of offset " << word);
                set.run(1, lists, word, sound ^ (1u << bit));
                REQUIRE_FALSE(lists.validate().ok());
                set.run(1, lists, word, sound);
            }
        require_sound(lists, capacity);
    }
}

TEST_CASE("scrambled offsets and counts are found and end", "[corruption]") {
    CountedCorruption corruption;
    int tried = 0;
    for (cl_uint seed = 0; seed < 50; ++seed)
        for (const cl_uint range : {2u, 31u, 300u, 401u, 10'000u, 0xFFFFFFFFu}) {
            INFO("seed " << seed << ", range " << range);
            corruption.scramble(seed, range);
            const Validation found = corruption.lists.validate();
            REQUIRE_FALSE(found.ok());
            REQUIRE(found.broken_links + found.repeated_nodes <= CountedCorruption::cells);
            ++tried;
        }
    corruption.restore();
    std::cout << "corruption: " << tried << " scrambled containers" << std::endl;
}

TEST_CASE("containers without cells, nodes or records are sound in every storage", "[corruption]") {
    CELLIST_EACH_STORAGE(storage);
    for (const Shape& shape : {Shape{0}, Shape{1}, Shape{100}})
        for (const std::uint32_t room : {0u, 1u, 33u}) {
            const Validation found =
                Lists<Item>(device(), shape,
                            {.storage = storage, .capacity_nodes = room, .slots = room})
                    .validate();
            REQUIRE(found.ok());
            REQUIRE_FALSE(found.message().empty());
        }
}

}  // namespace
}  // namespace cellist::test
