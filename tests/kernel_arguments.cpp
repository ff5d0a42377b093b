// SPDX-License-Identifier: MIT
// Arguments that do not fit the kernel's parameters are refused, naming the parameter.
#include "support/errors.hpp"
#include "support/inserts.hpp"

namespace cellist::test {

struct Glow {
    cl_uint strength;
};
CELLIST_STRUCT(Glow, strength);

namespace {

constexpr auto arguments_source = R"(
#include <cellist/lists.clh>
kernel void arguments(CELLIST_LISTS(Item, lists), global uint* out, uint count, float4 offset,
                      const Item item, ulong wide, uchar small, local uint* scratch,
                      constant float* table)
{
    out[0] = count + (uint)offset.w + item.id + (uint)wide + small + (uint)table[1];
    scratch[get_local_id(0)] = 1;
}
)";

struct Fixture {
    Lists<Item> lists{device(), {5}};
    Kernel kernel{device(), arguments_source, "arguments", lists};
    Buffer<cl_uint> out{device(), 1};
    Buffer<cl_float> table{device(), std::vector<cl_float>{1, 500000, 3}};
    cl_float4 offset{{1, 2, 3, 4000}};
    Item item{1.0f, 300};
};

TEST_CASE_METHOD(Fixture, "arguments of every kind reach the kernel") {
    kernel.run(1, lists, out, cl_uint{1}, offset, item, cl_ulong{20}, cl_uchar{5}, LocalMemory{64},
               table);
    REQUIRE(out.download()[0] == 504326);
    kernel.run(1, lists, out.cl(), 1, offset, item, 20ul, 'a', LocalMemory{64}, table.cl());
    REQUIRE(out.download()[0] == 504321 + 'a');
}

TEST_CASE_METHOD(Fixture, "a wrong number of arguments is refused, naming both numbers") {
    const auto error = error_of([&] { kernel.run(1, lists, out, cl_uint{1}); });
    INFO(error.what());
    REQUIRE(contains(error.what(), "arguments"));
    REQUIRE(contains(error.what(), "takes 9 arguments"));
    REQUIRE(contains(error.what(), "given 3"));
    REQUIRE_THROWS_AS(kernel.run(1), Error);
    REQUIRE_THROWS_AS(kernel.run(1, lists, out, cl_uint{1}, offset, item, cl_ulong{20}, cl_uchar{5},
                                 LocalMemory{64}, table, cl_uint{1}),
                      Error);
}

TEST_CASE_METHOD(Fixture, "an argument of the wrong size is refused, naming the parameter") {
    const auto refused = [&](const char* parameter, auto&& call) {
        INFO(parameter);
        const std::string message = error_of(call).what();
        INFO(message);
        REQUIRE(contains(message, parameter));
        REQUIRE(contains(message, "bytes"));
    };
    refused("count", [&] {
        kernel.run(1, lists, out, cl_ulong{1}, offset, item, cl_ulong{20}, cl_uchar{5},
                   LocalMemory{64}, table);
    });
    refused("offset", [&] {
        kernel.run(1, lists, out, cl_uint{1}, 1.0f, item, cl_ulong{20}, cl_uchar{5},
                   LocalMemory{64}, table);
    });
    refused("item", [&] {
        kernel.run(1, lists, out, cl_uint{1}, offset, cl_uint{1}, cl_ulong{20}, cl_uchar{5},
                   LocalMemory{64}, table);
    });
    refused("wide", [&] {
        kernel.run(1, lists, out, cl_uint{1}, offset, item, cl_uint{20}, cl_uchar{5},
                   LocalMemory{64}, table);
    });
    refused("small", [&] {
        kernel.run(1, lists, out, cl_uint{1}, offset, item, cl_ulong{20}, 5, LocalMemory{64},
                   table);
    });
}

TEST_CASE_METHOD(Fixture, "an argument of the wrong kind is refused, naming the parameter") {
    const auto refused = [&](const char* parameter, auto&& call) {
        INFO(parameter);
        const std::string message = error_of(call).what();
        INFO(message);
        REQUIRE(contains(message, parameter));
    };
    refused("out", [&] {
        kernel.run(1, lists, cl_uint{1}, cl_uint{1}, offset, item, cl_ulong{20}, cl_uchar{5},
                   LocalMemory{64}, table);
    });
    refused("count", [&] {
        kernel.run(1, lists, out, out, offset, item, cl_ulong{20}, cl_uchar{5}, LocalMemory{64},
                   table);
    });
    refused("scratch", [&] {
        kernel.run(1, lists, out, cl_uint{1}, offset, item, cl_ulong{20}, cl_uchar{5}, table,
                   table);
    });
    refused("table", [&] {
        kernel.run(1, lists, out, cl_uint{1}, offset, item, cl_ulong{20}, cl_uchar{5},
                   LocalMemory{64}, LocalMemory{64});
    });
    refused("lists_nodes", [&] {
        kernel.run(1, cl_uint{1}, lists, out, offset, item, cl_ulong{20}, cl_uchar{5},
                   LocalMemory{64}, table);
    });
}

TEST_CASE("an argument of the wrong type is refused, naming both types") {
    Kernel kernel(device(),
                  "kernel void f(global float* out, uint n, float4 v) { out[0] = n + v.x; }", "f");
    const Buffer<cl_float> out(device(), 1);
    const Buffer<cl_uint> integers(device(), 1);
    const cl_float4 v{{1, 2, 3, 4}};
    kernel.run(1, out, cl_uint{1}, v);
    kernel.run(1, out, cl_int{1}, v);             // signs are not compared
    kernel.run(1, integers.cl(), cl_uint{1}, v);  // raw memory has no type
    const std::string buffer = error_of([&] { kernel.run(1, integers, cl_uint{1}, v); }).what();
    REQUIRE(contains(buffer, "takes float, was given uint"));
    const std::string value = error_of([&] { kernel.run(1, out, 1.0f, v); }).what();
    REQUIRE(contains(value, "takes uint, was given float"));
}

TEST_CASE("a refused argument has the number that it is written at, and both sizes") {
    const Lists<Item> lists(device(), {5});
    Kernel kernel(device(), "kernel void f(CELLIST_LISTS(Item, lists), uint n, float radius) {}",
                  "f", lists);
    const std::string size = error_of([&] { kernel.run(1, lists, cl_uint{1}, 0.1); }).what();
    REQUIRE(
        contains(size, "argument 3 'float radius': takes float of 4 bytes, was given double of 8"));
}

TEST_CASE("lists of another record are refused, naming both records") {
    Lists<Item> items(device(), {5});
    const Lists<Glow> glows(device(), {5});
    Kernel kernel(device(), "kernel void f(CELLIST_LISTS(Glow, lists)) {}", "f", glows);
    const auto error = error_of([&] { kernel.run(1, items); });
    INFO(error.what());
    REQUIRE(contains(error.what(), "lists of Glow"));
    REQUIRE(contains(error.what(), "lists of Item"));
}

TEST_CASE("memory of another context is refused") {
    Kernel kernel(device(), "kernel void f(global uint* out) { *out = 1; }", "f");
    const Device other = Device::choose();
    const Buffer<cl_uint> theirs(other, 1);
    REQUIRE(contains(error_of([&] { kernel.run(1, theirs); }).what(), "another context"));
    REQUIRE(contains(error_of([&] { kernel.run(1, cl::Buffer()); }).what(), "an empty buffer"));
}

TEST_CASE_METHOD(Fixture, "a refused launch leaves the kernel usable") {
    REQUIRE_THROWS_AS(kernel.run(1), Error);
    kernel.run(1, lists, out, cl_uint{1}, offset, item, cl_ulong{20}, cl_uchar{5}, LocalMemory{64},
               table);
    REQUIRE(out.download()[0] == 504326);
}

}  // namespace
}  // namespace cellist::test
