// SPDX-License-Identifier: MIT
// A build whose kernels insert into a container that is no part of it ends in an error that names
// the container, and keeps nothing. Containers that kernels only read are no matter.
#include <optional>

#include "support/errors.hpp"
#include "support/inserts.hpp"
#include "support/storages.hpp"

namespace cellist::test {
namespace {

constexpr auto into_both_source = R"(
#include <cellist/lists.clh>

// One record into each container; `ways` has a bit for each that takes one.
kernel void into_both(CELLIST_LISTS(Item, first), CELLIST_LISTS(Item, second), uint ways)
{
    const uint i = get_global_id(0);
    Item item = { (float)i, i };
    if (ways & 1) cellist_insert(first, i % cellist_cells(first), item);
    if (ways & 2) cellist_insert(second, i % cellist_cells(second), item);
}
)";

struct TwoContainers {
    explicit TwoContainers(Storage storage, Overflow overflow = Overflow::grow)
        : a(device(), {17}, options(storage, overflow)), b(device(), {4, 3}, options(storage)) {}
    static ListsOptions options(Storage storage, Overflow overflow = Overflow::grow) {
        return {.storage = storage, .overflow = overflow, .capacity_nodes = 2000, .slots = 100};
    }
    void run(cl_uint ways) { kernel.run(1000, a, b, ways); }

    Lists<Item> a, b;
    Kernel kernel{device(), into_both_source, "into_both", a, b};
};

void require_named(const Error& error) {
    INFO(error.what());
    for (const char* part : {"1000 inserts", "lists of Item", "shape 4x3", "parameter 'second'",
                             "kernel into_both", "no part of the build"})
        REQUIRE(contains(error.what(), part));
}

TEST_CASE("inserts into a container that is no part of the build are an error") {
    CELLIST_EACH_STORAGE(storage);
    TwoContainers scene(storage);
    scene.b.build([&] { scene.run(2); });  // here a is only passed on
    const auto kept = scene.b.download().records().size();
    REQUIRE(kept == 1000);

    require_named(error_of([&] { scene.a.build([&] { scene.run(3); }); }));
    require_sound(scene.a, 0);
    REQUIRE(scene.a.download().records().empty());
    REQUIRE(scene.b.download().records().size() == kept);
    REQUIRE(scene.b.validate().late_inserts == 1000);

    require_named(error_of([&] { scene.a.build(scene.kernel, 1000, scene.b, cl_uint{3}); }));
    // What was refused before is no fault of this build.
    require_complete(scene.a.build(scene.kernel, 1000, scene.b, cl_uint{1}), 1000);
    REQUIRE(scene.b.download().records().size() == kept);

    const auto reports = cellist::build([&] { scene.run(3); }, scene.a, scene.b);
    for (const BuildReport& report : reports) require_complete(report, 1000);
}

TEST_CASE("a build that was started tells so in get()") {
    CELLIST_EACH_STORAGE(storage);
    for (const Overflow overflow : {Overflow::grow, Overflow::drop}) {
        TwoContainers scene(storage, overflow);
        Pending<BuildReport> pending = scene.a.build_async(scene.kernel, 1000, scene.b, cl_uint{3});
        const Error error = error_of([&] { pending.get(); });
        if (storage == Storage::counted && overflow == Overflow::drop)
            REQUIRE(contains(error.what(), "refused 2000 inserts in 2 passes"));
        else
            require_named(error);
        require_sound(scene.a, 0);
        Pending<BuildReport> good = scene.a.build_async(scene.kernel, 1000, scene.b, cl_uint{1});
        require_complete(good.get(), 1000);
    }
}

TEST_CASE("all builds at once and builds in slices look as well") {
    CELLIST_EACH_STORAGE(storage);
    TwoContainers scene(storage);
    Lists<Item> c(device(), {5}, TwoContainers::options(storage));
    Kernel one(device(), insert_source("Item"), "insert_all", c);
    const Buffer<cl_uint> cells(device(), std::vector<cl_uint>{0});
    const Buffer<Item> records(device(), std::vector<Item>{{1.0f, 1}});
    const auto insert = [&] {
        scene.run(3);
        one.run(1, c, cells, records, cl_uint{1});
    };
    require_named(error_of([&] { cellist::build(insert, scene.a, c); }));
    require_sound(scene.a, 0);
    require_sound(c, 0);
    require_named(
        error_of([&] { scene.a.build_slices([&] { scene.run(3); }, [](const Slice&) {}); }));
    require_sound(scene.a, 0);
}

TEST_CASE("a build inside of another counts for its own containers, and hides nothing") {
    CELLIST_EACH_STORAGE(storage);
    TwoContainers scene(storage);
    // b is built first, then read.
    require_complete(scene.a.build([&] {
        scene.b.build([&] { scene.kernel.run(10, scene.a, scene.b, cl_uint{2}); });
        scene.run(1);
    }),
                     1000);
    REQUIRE(scene.b.lengths().total == 10);
    // b refuses inserts before it is cleared or built.
    require_named(error_of([&] {
        scene.a.build([&] {
            scene.run(3);
            scene.b.clear();
        });
    }));
    require_named(error_of([&] {
        scene.a.build([&] {
            scene.run(3);
            scene.b.build([&] { scene.kernel.run(10, scene.a, scene.b, cl_uint{2}); });
        });
    }));
    require_sound(scene.a, 0);
}

TEST_CASE("a container that a build's kernels have read may go at once") {
    TwoContainers scene(Storage::linked);
    for (const cl_uint ways : {1u, 3u})
        require_complete(scene.a.build([&] {
            Lists<Item> helper(device(), {7}, {.capacity_nodes = 10});
            scene.kernel.run(1000, scene.a, helper, ways);
        }),
                         1000);
}

}  // namespace
}  // namespace cellist::test
