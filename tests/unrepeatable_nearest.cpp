// SPDX-License-Identifier: MIT
// nearest() runs a kernel to rank and to fill. One that inserts other records the second time
// ends in an error, unless it cannot be told, and leaves the container usable.
#include "support/errors.hpp"
#include "support/inserts.hpp"

namespace cellist::test {
namespace {

constexpr auto vary_nearest_source = R"(
#include <cellist/lists.clh>

// Work-item i inserts into cell i % cells. `runs` counts the work-items that ever ran.
kernel void vary(CELLIST_LISTS(Item, lists), uint way, volatile global uint* runs)
{
    const uint i = get_global_id(0), n = get_global_size(0), cells = cellist_cells(lists);
    const uint run = atomic_inc(runs) / n;
    uint cell = i % cells;
    Item item = { (float)(i / cells), i };
    if (way == 1 && run) item.key += 1000;           // all come behind those that were ranked
    if (way == 2 && run) item.key -= 1000;           // all come before
    if (way == 3 && run) cell = (i + 1) % (cells + 1);
    if (way == 4 && run && i == n - 1) return;       // one less, far behind
    if (way == 5 && run && i == n - 1) cellist_insert(lists, cell, item);
    if (way == 6 && run && i == n - 1) cell = cells; // rejected
    if (way == 7 && run) return;
    if (way == 8 && !run) return;
    if (way == 9 && run && i == 0) item.key = 500;   // the first becomes the last
    cellist_insert(lists, cell, item);
}
)";

TEST_CASE("a kernel that does not repeat itself while the nearest are kept ends in an error") {
    Buffer<cl_uint> runs(device(), 1);
    for (const cl_uint slots : {1u, 4u, 200u}) {
        Lists<Item> lists(device(), {10}, {.storage = nearest(&Item::key, slots)});
        Kernel vary(device(), vary_nearest_source, "vary", lists);
        const auto build = [&](cl_uint way) {
            runs.fill(0);
            return lists.build(vary, 1000, way, runs);
        };
        const std::uint64_t kept = 10 * std::min(slots, 100u);
        for (cl_uint way = 0; way < 10; ++way) {
            // With room for all, other keys change nothing.
            const bool repeats = way == 0 || (slots == 200 && (way == 1 || way == 2 || way == 9));
            INFO(slots << " slots, way " << way);
            if (!repeats) {
                const Error error = error_of([&] { build(way); });
                INFO(error.what());
                REQUIRE(contains(error.what(), "same records every time"));
                require_sound(lists, 0);
            }
            const BuildReport report = build(repeats ? way : 0);
            REQUIRE(report.attempted == 1000);
            REQUIRE(report.stored == kept);
            REQUIRE(report.dropped == 1000 - kept);
            require_sound(lists, kept);
        }
    }
}

}  // namespace
}  // namespace cellist::test
