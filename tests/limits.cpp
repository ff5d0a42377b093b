// SPDX-License-Identifier: MIT
// Sizes are checked against the limits before anything is allocated; the message names both.
#include "support/errors.hpp"
#include "support/inserts.hpp"
#include "support/skip.hpp"

namespace cellist::test {
namespace {

TEST_CASE("a capacity over the device's limit is refused, naming the capacity and the limit") {
    const std::uint64_t limit =
        std::min<std::uint64_t>(device().info().max_allocation_bytes / 12, 0xC0000000u);
    for (const std::uint64_t capacity :
         {limit + 1, std::uint64_t{1} << 32, ~std::uint64_t{0} / 12, ~std::uint64_t{0}}) {
        INFO("capacity " << capacity);
        const auto error =
            error_of([&] { Lists<Item>(device(), {5}, {.capacity_nodes = capacity}); });
        INFO(error.what());
        REQUIRE(contains(error.what(), std::to_string(capacity)));
        REQUIRE(contains(error.what(), std::to_string(limit)));
    }
}

TEST_CASE("a shape over the device's limit is refused, naming the shape and the limit") {
    const std::uint64_t limit = device().info().max_allocation_bytes / 4;
    if (limit >= Shape::cells_max) CELLIST_SKIP("no shape is over the device's limit");
    const Shape shape{2, limit / 2 + 1};
    const auto error = error_of([&] { Lists<Item>(device(), shape); });
    INFO(error.what());
    REQUIRE(contains(error.what(), shape.to_string()));
    REQUIRE(contains(error.what(), std::to_string(limit)));
}

TEST_CASE("slots whose heads no device has room for are refused, and no limit is of 0 cells") {
    bool has_refused = false;
    for (const std::uint32_t slots : {0x40000000u, 0xFFFFFFFFu})
        for (const Shape& shape : {Shape{1}, Shape{5}, Shape{0x7FFFFFFF}}) {
            const double bytes = 4.0 * slots * static_cast<double>(shape.cells());
            if (bytes <= static_cast<double>(device().info().max_allocation_bytes)) continue;
            has_refused = true;
            const auto error = error_of(
                [&] { Lists<Item>(device(), shape, {.storage = nearest(&Item::key, slots)}); });
            INFO(error.what());
            REQUIRE_FALSE(contains(error.what(), "limit of 0 "));
            REQUIRE((contains(error.what(), "lower slots") || contains(error.what(), "cells (")));
        }
    if (!has_refused) CELLIST_SKIP("the device has room for all of them");
}

TEST_CASE("dimensions that a shape does not have are of one cell") {
    const Shape shape{5, 0};
    REQUIRE(shape.extent(1) == 0);
    for (const std::size_t dimension :
         {std::size_t{2}, std::size_t{3}, std::size_t{4}, ~std::size_t{0}})
        REQUIRE(shape.extent(dimension) == 1);
}

TEST_CASE("a shape that cannot be indexed is refused, naming the value and the limit") {
    const auto message = [](std::initializer_list<detail::Extent> extents) {
        return std::string(error_of([&] { Shape shape(extents); }).what());
    };
    REQUIRE(contains(message({0x80000000u}), "2147483648"));
    REQUIRE(contains(message({0x80000000u}), "2147483647"));
    REQUIRE(contains(message({1, ~std::uint64_t{0}}), "18446744073709551615"));
    REQUIRE(contains(message({100'000, 100'000}), "100000x100000"));
    REQUIRE(contains(message({100'000, 100'000}), std::to_string(Shape::cells_max)));
    REQUIRE(contains(message({0x7FFFFFFF, 0x7FFFFFFF, 0x7FFFFFFF, 0x7FFFFFFF}),
                     std::to_string(Shape::cells_max)));
    REQUIRE(contains(message({65'536, 65'536}), "65536x65536"));
    REQUIRE(contains(message({}), "1 to 4"));
    REQUIRE(contains(message({1, 2, 3, 4, 5}), "5"));
}

TEST_CASE("a shape knows its extents and cells") {
    const Shape shape{4, 3, 2};
    REQUIRE(shape.dimensions() == 3);
    REQUIRE(shape.cells() == 24);
    REQUIRE(shape.extent(1) == 3);
    REQUIRE(shape.extent(3) == 1);
    REQUIRE(shape.to_string() == "4x3x2");
    REQUIRE(shape.cell({3, 2, 1}) == 23);
    REQUIRE(shape.cell({1, 2}) == 9);
    REQUIRE(shape.cell({}) == 0);
    REQUIRE(shape == Shape{4, 3, 2});
    REQUIRE_FALSE(shape == Shape{4, 3, 2, 1});
    REQUIRE(Shape{0x7FFFFFFF, 2}.cells() == 0xFFFFFFFEu);
    REQUIRE(Shape{0x7FFFFFFF, 0x7FFFFFFF, 0}.cells() == 0);
    REQUIRE_THROWS_AS(shape.cell({4, 0, 0}), Error);
    REQUIRE_THROWS_AS(shape.cell({0, 0, 0, 0}), Error);
    REQUIRE_THROWS_AS((Shape{0, 3}.cell({})), Error);
}

TEST_CASE("extents and coordinates are integers of any type, and not negative") {
    int width = 4;
    const short height = 3;
    const std::uint64_t depth = 2;
    REQUIRE(Shape{width, height, depth} == Shape{4u, 3u, 2u});
    const Lists<Item> lists(device(), {width, height});
    REQUIRE(lists.shape().cells() == 12);
    REQUIRE(lists.shape().cell({width - 1, height - 1}) == 11);
    REQUIRE(lists.download()[{width - 1, height - 1}].empty());
    width = -4;
    const auto of_extent = error_of([&] { Shape{width, height}; });
    INFO(of_extent.what());
    REQUIRE(contains(of_extent.what(), "-4 is negative"));
    REQUIRE_THROWS_AS(Lists<Item>(device(), {height, width}), Error);
    REQUIRE_THROWS_AS(lists.shape().cell({0, -1}), Error);
    REQUIRE_THROWS_AS(lists.download()[{-1}], Error);
    REQUIRE_THROWS_AS(Shape{std::int64_t{-1}}, Error);
    REQUIRE_THROWS_AS(Shape{std::numeric_limits<std::int64_t>::min()}, Error);
}

TEST_CASE("a demand over the device's limit ends in an error and leaves the lists usable") {
    // The dropped counter stands in for the billions of inserts.
    Lists<Item> lists(device(), {5}, {.capacity_nodes = 100});
    Kernel demand(device(), R"(
#include <cellist/lists.clh>
kernel void demand(CELLIST_LISTS(Item, lists)) { lists_shards[0].dropped_high = 7; }
)",
                  "demand", lists);
    const auto error = error_of<OverflowError>([&] { lists.build(demand, 1); });
    INFO(error.what());
    REQUIRE(contains(error.what(), std::to_string(std::uint64_t{7} << 32)));
    REQUIRE(error.report().dropped == std::uint64_t{7} << 32);
    REQUIRE(error.report().attempted == std::uint64_t{7} << 32);
    REQUIRE(lists.capacity_nodes() == 100);
    require_sound(lists, 0);
    CELLIST_RANDOM(random, 60u);
    require_complete(Inserter(lists).build(lists, random_inserts(144, 5, random)), 144);
}

}  // namespace
}  // namespace cellist::test
