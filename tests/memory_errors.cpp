// SPDX-License-Identifier: MIT
// Users catch every lack of memory in one place: a MemoryError, or an error that out_of_memory()
// knows.
#include <initializer_list>

#include "support/errors.hpp"
#include "support/inserts.hpp"

namespace cellist::test {
namespace {

TEST_CASE("sizes over a limit are MemoryErrors") {
    const std::uint64_t limit = device().info().max_allocation_bytes;
    REQUIRE(out_of_memory(error_of<MemoryError>([&] { Buffer<cl_uint>(device(), limit); })));
    REQUIRE(out_of_memory(
        error_of<MemoryError>([&] { Lists<Item>(device(), {5}, {.capacity_nodes = limit}); })));
    for (const Storage storage : {Storage::linked, Storage::counted, Storage::automatic})
        REQUIRE(out_of_memory(error_of<MemoryError>(
            [&] { Lists<Item>(device(), {1000}, {.storage = storage, .budget_bytes = 1000}); })));
}

TEST_CASE("a build that does not fit is a MemoryError") {
    CELLIST_RANDOM(random, 310u);
    const Inserts<Item> inserts = random_inserts(100'000, 50, random);
    for (const ListsOptions& options :
         {ListsOptions{.overflow = Overflow::stop, .capacity_nodes = 93},
          ListsOptions{.capacity_nodes = 93, .budget_bytes = 100'000}}) {
        Lists<Item> lists(device(), {50}, options);
        Inserter inserter(lists);
        REQUIRE(out_of_memory(error_of<MemoryError>([&] { inserter.build(lists, inserts); })));
    }
}

TEST_CASE("out_of_memory() knows the codes of drivers, and no other error") {
    for (const cl_int code :
         {CL_MEM_OBJECT_ALLOCATION_FAILURE, CL_OUT_OF_RESOURCES, CL_OUT_OF_HOST_MEMORY})
        REQUIRE(out_of_memory(OpenClError("clCreateBuffer", code)));
    REQUIRE_FALSE(out_of_memory(OpenClError("clCreateBuffer", CL_INVALID_VALUE)));
    REQUIRE_FALSE(out_of_memory(error_of([] { Shape{}; })));
    REQUIRE_FALSE(
        out_of_memory(error_of([] { Lists<Item>(device(), {5}, {.overflow = Overflow::stop}); })));
}

}  // namespace
}  // namespace cellist::test
