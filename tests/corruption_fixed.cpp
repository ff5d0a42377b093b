// SPDX-License-Identifier: MIT
// validate() finds counts of Storage::fixed that are wrong, and no count leads out of its cell.
#include <iostream>

#include "support/inserts.hpp"

namespace cellist::test {
namespace {

constexpr auto set_count_source = R"(
#include <cellist/lists.clh>
kernel void set_count(CELLIST_LISTS(Item, lists), uint cell, uint count)
{
    lists_heads[cell] = count;
}
)";

class FixedCorruption {
public:
    static constexpr cl_uint cells = 10;
    static constexpr cl_uint slots = 8;

    /// Lists of `length` records each; those beyond the slots are dropped.
    explicit FixedCorruption(cl_uint length)
        : lists(device(), {cells},
                {.storage = Storage::fixed, .overflow = Overflow::drop, .slots = slots}),
          length_(length),
          set_(device(), set_count_source, "set_count", lists) {
        Inserts<Item> inserts;
        for (cl_uint i = 0; i < cells * length; ++i)
            inserts.add(i % cells, {static_cast<cl_float>(i), i});
        Inserter(lists).build(lists, inserts);
        require_sound(lists, std::uint64_t{cells} * std::min(length, slots));
    }

    void set(cl_uint cell, cl_uint count) { set_.run(1, lists, cell, count); }

    void require_found(cl_uint cell, cl_uint count) {
        INFO("count of cell " << cell << " set from " << length_ << " to " << count);
        set_.run(1, lists, cell, count);
        REQUIRE_FALSE(lists.validate().ok());
        REQUIRE_FALSE(lists.validate().message().empty());
        // However wrong, a count leads to the cell's own slots only.
        REQUIRE(lists.lengths().longest <= slots);
        REQUIRE(lists.download().records().size() <= std::size_t{cells} * slots);
        set_.run(1, lists, cell, length_);
        REQUIRE(lists.validate().ok());
        ++tried;
    }

    Lists<Item> lists;
    int tried = 0;

private:
    cl_uint length_;
    Kernel set_;
};

TEST_CASE("counts beyond the slots that no drop explains are found", "[corruption]") {
    int tried = 0;
    for (const cl_uint length : {0u, 5u, 8u, 11u}) {
        FixedCorruption corruption(length);
        for (cl_uint cell = 0; cell < FixedCorruption::cells; ++cell)
            for (const cl_uint count : {9u, 10u, 1000u, 0x7FFFFFFFu, 0x80000000u, 0xFFFFFFFFu})
                corruption.require_found(cell, count);
        tried += corruption.tried;
    }
    std::cout << "corruption: " << tried << " counts of fixed lists" << std::endl;
}

TEST_CASE("counts that hide dropped records are found", "[corruption]") {
    FixedCorruption corruption(11);
    for (cl_uint cell = 0; cell < FixedCorruption::cells; ++cell)
        for (const cl_uint count : {0u, 7u, 8u, 10u}) corruption.require_found(cell, count);
}

TEST_CASE("counts that have moved between cells are found", "[corruption]") {
    for (const cl_uint length : {5u, 11u}) {
        FixedCorruption corruption(length);
        corruption.set(2, length - 1);
        corruption.set(7, length + 1);
        const Validation found = corruption.lists.validate();
        REQUIRE(found.broken_links > 0);
        REQUIRE(found.lost_nodes + 1 <= 2);
        corruption.set(2, length);
        corruption.set(7, length);
        REQUIRE(corruption.lists.validate().ok());
    }
}

TEST_CASE("counts within the slots that are wrong are found", "[corruption]") {
    FixedCorruption corruption(5);
    for (cl_uint cell = 0; cell < FixedCorruption::cells; ++cell)
        for (const cl_uint count : {0u, 4u, 6u, 8u}) corruption.require_found(cell, count);
}

}  // namespace
}  // namespace cellist::test
