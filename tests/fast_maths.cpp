// SPDX-License-Identifier: MIT
// Build options that let the compiler assume finite floats change neither cells nor orders.
#include <cmath>
#include <limits>

#include "support/errors.hpp"
#include "support/inserts.hpp"

namespace cellist::test {
namespace {

constexpr const char* maths_options[] = {"", "-cl-finite-math-only",
                                         "-cl-unsafe-math-optimizations", "-cl-fast-relaxed-math"};

template <class T>
std::vector<T> coordinates() {
    using Limits = std::numeric_limits<T>;
    return {Limits::quiet_NaN(),
            -Limits::quiet_NaN(),
            Limits::infinity(),
            -Limits::infinity(),
            Limits::max(),
            Limits::lowest(),
            T(2147483648.0),
            T(-2147483648.0),
            T(2147483520.0),
            T(-1),
            T(-0.25),
            T(-0.0),
            T(0),
            T(0.5),
            T(3.75),
            T(4)};
}

/// The cell of each coordinate in a row of four.
template <class T>
void require_cells(const std::string& name) {
    const Lists<Item> lists(device(), {4});
    const std::vector<T> at = coordinates<T>();
    const Buffer<T> places(device(), at);
    const Buffer<cl_uint> cells(device(), at.size());
    for (const char* options : maths_options) {
        INFO(name << " " << options);
        Kernel kernel(
            device(),
            Source{.text =
                       "kernel void cells(CELLIST_LISTS(Item, lists), global const " + name +
                       "* at, global uint* cells) {\n"
                       "    cells[get_global_id(0)] = cellist_cell1(lists, at[get_global_id(0)]);\n"
                       "}\n",
                   .options = options},
            "cells", lists);
        kernel.run(at.size(), lists, places, cells);
        const std::vector<cl_uint> found = cells.download();
        for (std::size_t i = 0; i < at.size(); ++i) {
            INFO("at " << at[i]);
            const bool inside = at[i] >= 0 && at[i] < 4;  // not of NaN
            REQUIRE(found[i] == (inside ? static_cast<cl_uint>(at[i]) : 0xFFFFFFFFu));
        }
    }
}

TEST_CASE("NaN and infinity are outside of the shape with every build option", "[oclgrind]") {
    require_cells<cl_float>("float");
    if (device().info().fp64) require_cells<cl_double>("double");
}

TEST_CASE("NaN, infinity and -0 are in order with every build option") {
    constexpr cl_float infinity = std::numeric_limits<cl_float>::infinity();
    // In the documented order: of the NaNs the positive come first.
    const std::vector<cl_float> keys{-infinity, -1, -0.0f, 0.0f, 1, infinity, NAN, -NAN};
    const auto count = static_cast<cl_uint>(keys.size());
    Inserts<Item> inserts;
    for (cl_uint i = count; i > 0; --i) inserts.add(0, {keys[i - 1], i - 1});
    for (const char* options : maths_options) {
        INFO(options);
        Lists<Item> lists(device(), {1});
        Kernel insert(device(), Source{.text = insert_source("Item"), .options = options},
                      "insert_all", lists);
        lists.build(insert, count, Buffer<cl_uint>(device(), inserts.cells),
                    Buffer<Item>(device(), inserts.records), count);
        Kernel nearest(
            device(),
            Source{.text = "kernel void nearest(CELLIST_LISTS(Item, lists), global uint* ids) {\n"
                           "    Item out[8];\n"
                           "    cellist_nearest(lists, 0, key, 8, out);\n"
                           "    for (uint i = 0; i < 8; ++i) ids[i] = out[i].id;\n"
                           "}\n",
                   .options = options},
            "nearest", lists);
        const Buffer<cl_uint> ids(device(), count);
        nearest.run(1, lists, ids);
        REQUIRE(ids.download() == std::vector<cl_uint>{0, 1, 2, 3, 4, 5, 6, 7});

        Lists<Item> few(device(), {1}, {.storage = cellist::nearest(&Item::key, 6)});
        few.build(insert, count, Buffer<cl_uint>(device(), inserts.cells),
                  Buffer<Item>(device(), inserts.records), count);
        few.sort(&Item::id);
        const HostLists<Item> kept = few.download();
        REQUIRE(kept.records().size() == 6);
        for (cl_uint i = 0; i < 6; ++i) REQUIRE(kept.records()[i].id == i);
    }
}

}  // namespace
}  // namespace cellist::test
