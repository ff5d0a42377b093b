// SPDX-License-Identifier: MIT
// Storage::counted runs a kernel twice. One that inserts other records the second time ends in an
// error, writes nowhere but into the places of the cells that it inserts into, and leaves the
// container usable.
#include <iostream>

#include "support/errors.hpp"
#include "support/inserts.hpp"

namespace cellist::test {
namespace {

constexpr auto vary_source = R"(
#include <cellist/lists.clh>

#define UNTOUCHED 0xABCDABCDu

static void put(CELLIST_LISTS(Item, lists), uint cell, uint id)
{
    Item item = { (float)cell, id };
    cellist_insert(lists, cell, item);
}

// Work-item i inserts into cell i % cells. `runs` counts the work-items that ever ran.
kernel void vary(CELLIST_LISTS(Item, lists), uint way, volatile global uint* runs)
{
    const uint i = get_global_id(0), n = get_global_size(0), cells = cellist_cells(lists);
    const uint run = atomic_inc(runs) / n;
    uint cell = i % cells;
    uint id = i;
    if (way == 1) id = i + run * n;                              // other records
    if (way == 2) cell = (i + run) % cells;                      // records change places
    if (way == 3 && run && i == 0) put(CELLIST_PASS(lists), cells - 1, n);
    if (way == 4 && run && i == n - 1) return;
    if (way == 5 && run && i == 0) cell = 1;
    if (way == 6 && run && i < 3) cell = cells + i;
    if (way == 7 && run && i == 0) put(CELLIST_PASS(lists), CELLIST_NONE, n);
    if (way == 8 && run) cell = 0;
    if (way == 9 && run) cell = cells - 1;
    if (way == 10 && run) return;
    if (way == 11 && !run) return;
    if (way == 12 && run)
        for (uint k = 0; k < 20; ++k) put(CELLIST_PASS(lists), (i + k) % (cells + 1), n + k);
    if (way == 13 && !run && i == 0) cell = cells;               // a rejection less
    put(CELLIST_PASS(lists), cell, id);
}

kernel void prepare(CELLIST_LISTS(Item, lists))
{
    const cellist_view lists_view = cellist_view_of(lists);
    if (lists_view.mode != CELLIST_CONTIGUOUS) return;
    cellist_get(lists, get_global_id(0)).id = UNTOUCHED;
}

// Counts the nodes that hold a record, and those among them that belong to another cell or to none.
kernel void check(CELLIST_LISTS(Item, lists), volatile global uint* written,
                  volatile global uint* wrong)
{
    const cellist_view lists_view = cellist_view_of(lists);
    if (lists_view.mode != CELLIST_CONTIGUOUS) return;
    const uint node = get_global_id(0);
    const Item item = cellist_get(lists, node);
    if (item.id == UNTOUCHED) return;
    atomic_inc(written);
    uint cell = 0;
    while (cell < cellist_cells(lists) && lists_heads[cell + 1] <= node) ++cell;
    if (cell == cellist_cells(lists) || item.key != (float)cell) atomic_inc(wrong);
}
)";

constexpr cl_uint varied_cells = 6;
constexpr cl_uint varied_records = 60;
constexpr cl_uint ways = 14;

/// Ways that insert as many records into each cell, and reject as many.
bool repeats_counts(cl_uint way) { return way <= 2; }

/// Requires that containers with these options report every way that does not repeat itself.
void require_errors(const std::vector<ListsOptions>& all_options) {
    Buffer<cl_uint> runs(device(), 1);
    Buffer<cl_uint> written(device(), 1);
    Buffer<cl_uint> wrong(device(), 1);
    wrong.fill(0);
    int thrown = 0;
    for (const ListsOptions& options : all_options) {
        Lists<Item> lists(device(), {varied_cells}, options);
        Kernel vary(device(), vary_source, "vary", lists);
        Kernel prepare(device(), vary_source, "prepare", lists);
        Kernel check(device(), vary_source, "check", lists);
        const auto build = [&](cl_uint way) {
            runs.fill(0);
            written.fill(0);
            return lists.build([&] {
                prepare.run(lists.capacity_nodes(), lists);
                vary.run(varied_records, lists, way, runs);
                check.run(lists.capacity_nodes(), lists, written, wrong);
            });
        };
        const std::uint64_t kept = std::min<std::uint64_t>(
            varied_records,
            options.overflow == Overflow::drop ? *options.capacity_nodes : varied_records);
        for (cl_uint way = 0; way < ways; ++way) {
            INFO("way " << way << ", policy " << static_cast<int>(options.overflow) << ", capacity "
                        << options.capacity_nodes.value_or(0));
            if (repeats_counts(way)) {
                const BuildReport report = build(way);
                REQUIRE(report.stored == kept);
                REQUIRE(report.attempted == varied_records);
                REQUIRE(report.dropped == varied_records - kept);
            } else {
                const Error error = error_of([&] { build(way); });
                INFO(error.what());
                REQUIRE(contains(error.what(), "same records every time"));
                require_sound(lists, 0);
                REQUIRE(lists.download().records().empty());
                ++thrown;
            }
            REQUIRE(wrong.download()[0] == 0);
            REQUIRE(written.download()[0] <= kept);

            REQUIRE(build(0).stored == kept);
            REQUIRE(written.download()[0] == kept);
            require_sound(lists, kept);
        }
    }
    REQUIRE(thrown == static_cast<int>(all_options.size()) * 11);
    std::cout << "unrepeatable: " << thrown << " builds ended in an error" << std::endl;
}

TEST_CASE("a kernel that does not repeat itself ends in an error and writes into no other list") {
    require_errors(
        {{.storage = Storage::counted},
         {.storage = Storage::counted, .capacity_nodes = 100},
         {.storage = Storage::counted, .overflow = Overflow::stop, .capacity_nodes = 60},
         {.storage = Storage::counted, .overflow = Overflow::drop, .capacity_nodes = 60},
         {.storage = Storage::counted, .overflow = Overflow::drop, .capacity_nodes = 25}});
}

// To the kernels, the policies and capacities differ only in whether the pool has room for all.
TEST_CASE("a kernel that does not repeat itself ends in an error, with room for all or for a part",
          "[oclgrind]") {
    require_errors(
        {{.storage = Storage::counted},
         {.storage = Storage::counted, .overflow = Overflow::drop, .capacity_nodes = 25}});
}

TEST_CASE("the second pass decides which records are stored") {
    Lists<Item> lists(device(), {varied_cells}, {.storage = Storage::counted});
    Kernel vary(device(), vary_source, "vary", lists);
    Buffer<cl_uint> runs(device(), 1);
    runs.fill(0);
    require_complete(lists.build(vary, varied_records, cl_uint{1}, runs), varied_records);
    const HostLists<Item> found = lists.download();
    std::vector<bool> seen(varied_records, false);
    for (std::uint64_t cell = 0; cell < varied_cells; ++cell)
        for (const Item& item : found.cell(cell)) {
            REQUIRE(item.id >= varied_records);
            REQUIRE(item.id < 2 * varied_records);
            REQUIRE((item.id - varied_records) % varied_cells == cell);
            REQUIRE_FALSE(seen[item.id - varied_records]);
            seen[item.id - varied_records] = true;
        }
}

}  // namespace
}  // namespace cellist::test
