// SPDX-License-Identifier: MIT
// A record or a container of another struct than the lists' does not compile: the error names both
// structs and the user's line.
#include "support/errors.hpp"
#include "support/inserts.hpp"

namespace cellist::test {
namespace {

/// As wide as Item, with the members the other way round.
struct Swapped {
    cl_uint id;
    cl_float key;
};
CELLIST_STRUCT(Swapped, id, key);

struct WiderItem {
    cl_float key;
    cl_uint id;
    cl_float weight;
    cl_float2 place;
};
CELLIST_STRUCT(WiderItem, key, id, weight, place);

/// The error of a kernel whose third line has the mistake.
std::string error_of_line(const std::string& line, const std::string& functions = "") {
    const Lists<Item> lists(device(), {5});
    const Source source{
        .text = functions + "\nkernel void f(CELLIST_LISTS(Item, lists)) {\n" + line + "\n}\n",
        .file_name = "user.cl"};
    INFO(line);
    const auto error = error_of<OpenClError>(
        [&] { Kernel(device(), source, "f", lists, type<Swapped>, type<WiderItem>); });
    INFO(error.what());
    REQUIRE(contains(error.log(), "user.cl:3:"));
    REQUIRE_FALSE(contains(error.log(), "hint: name a Lists"));
    return error.what();
}

TEST_CASE("records of another struct are inserted and copied nowhere", "[oclgrind]") {
    for (const std::string name : {"Swapped", "WiderItem"})
        for (const std::string call : {
                 "cellist_insert(lists, 0, other);",
                 "other = cellist_get(lists, 0);",
                 "cellist_get(lists, 0) = other;",
                 "cellist_for_each(lists, 0, node) other = cellist_get(lists, node);",
                 "cellist_nearest(lists, 0, key, 1, &other);",
             }) {
            const std::string what = error_of_line(name + " other; " + call);
            REQUIRE(contains(what, "struct Item'"));
            REQUIRE(contains(what, name));
        }
    // A position where a cell is expected.
    (void)error_of_line("Item item; cellist_insert(lists, 1, 2, item);");
    REQUIRE(contains(error_of_line("cellist_insert(lists, 0, (Swapped){1, 2});"), "struct Item'"));
    const std::string number = error_of_line("cellist_insert(lists, 0, 1.0f);");
    REQUIRE(contains(number, "'float'"));
    REQUIRE(contains(number, "struct Item'"));
}

TEST_CASE("a container is not handed on to a function that takes other records", "[oclgrind]") {
    for (const std::string name : {"Swapped", "WiderItem"}) {
        const std::string what = error_of_line("    put(CELLIST_PASS(lists));",
                                               "void put(CELLIST_LISTS(" + name + ", others)) {}");
        REQUIRE(contains(what, "cellist_view_Item"));
        REQUIRE(contains(what, "cellist_view_" + name));
    }
}

TEST_CASE("the nearest are not taken by a member of another struct, or by a vector", "[oclgrind]") {
    const std::string other =
        error_of_line("Item out[2]; cellist_nearest(lists, 0, weight, 2, out);");
    REQUIRE(contains(other, "'weight'"));
    REQUIRE(contains(other, "struct Item'"));
    REQUIRE(contains(error_of_line("} void g(CELLIST_LISTS(WiderItem, wide)) { WiderItem out[2]; "
                                   "cellist_nearest(wide, 0, place, 2, out);"),
                     "place"));
}

TEST_CASE("a kernel for other records is not given the lists, or a buffer of them", "[oclgrind]") {
    Lists<Item> lists(device(), {5});
    const Lists<Swapped> others(device(), {5});
    Kernel kernel(device(), "kernel void f(CELLIST_LISTS(Swapped, others)) {}", "f", others, lists);
    const std::string list = error_of([&] { kernel.run(1, lists); }).what();
    REQUIRE(contains(list, "lists of Swapped"));
    REQUIRE(contains(list, "lists of Item"));
    Kernel reads(device(), "kernel void f(global const Swapped* others) {}", "f", type<Swapped>,
                 type<Item>);
    const std::string buffer = error_of([&] { reads.run(1, Buffer<Item>(device(), 3)); }).what();
    REQUIRE(contains(buffer, "Swapped"));
    REQUIRE(contains(buffer, "Item"));
}

}  // namespace
}  // namespace cellist::test
