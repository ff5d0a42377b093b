// Arguments that do not fit the kernel's parameters are refused, naming the parameter.
#include "support/errors.hpp"
#include "support/inserts.hpp"

namespace cellist::test {
namespace {

constexpr auto source = R"(
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
    Kernel kernel{device(), source, "arguments", lists};
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
    REQUIRE(contains(error.what(), "12"));
    REQUIRE(contains(error.what(), "6"));
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

TEST_CASE_METHOD(Fixture, "a refused launch leaves the kernel usable") {
    REQUIRE_THROWS_AS(kernel.run(1), Error);
    kernel.run(1, lists, out, cl_uint{1}, offset, item, cl_ulong{20}, cl_uchar{5}, LocalMemory{64},
               table);
    REQUIRE(out.download()[0] == 504326);
}

}  // namespace
}  // namespace cellist::test
