// SPDX-License-Identifier: MIT
// After Device::prepare, nothing is compiled.
#include <algorithm>
#include <fstream>
#include <functional>
#include <set>
#include <stdexcept>

#include "sort/sort.hpp"
#include "support/errors.hpp"
#include "support/inserts.hpp"
#include "support/storages.hpp"

namespace cellist::test {
namespace {

constexpr auto frame_source = R"(
#include <cellist/lists.clh>
kernel void insert(CELLIST_LISTS(Item, lists), uint count, uint in_first)
{
    const uint i = get_global_id(0);
    if (i >= count) return;
    const uint random = i * 2654435761u;
    cellist_insert(lists, i < in_first ? 0u : random % cellist_cells(lists),
                   (Item){(float)(random >> 8), i});
}
kernel void read(CELLIST_LISTS(Item, lists), global uint* sums)
{
    const uint cell = get_global_id(0);
    if (cell >= cellist_cells(lists)) return;
    uint sum = 0;
    cellist_for_each(lists, cell, node) sum += cellist_get(lists, node).id;
    sums[cell] = sum;
}
)";

constexpr cl_uint frame_cells = 3000;
constexpr cl_uint frame_count = 200'000;

/// The work-group functions of PoCL that the process has loaded: PoCL compiles one for each kernel,
/// local size and kind of range, when the kernel first runs. Empty on other drivers.
std::set<std::string> loaded_functions() {
    std::set<std::string> functions;
    std::ifstream maps("/proc/self/maps");
    for (std::string line; std::getline(maps, line);)
        if (line.ends_with(".so") && line.find("-goffs0") != std::string::npos)
            functions.insert(line.substr(line.find('/')));
    return functions;
}

/// What a program does in a frame.
struct Frame {
    Frame(const Device& its_device, const ListsOptions& options)
        : device(its_device), lists(device, {frame_cells}, options) {}

    void operator()() {
        lists.build(insert, Range::padded(frame_count), inserted, in_first);
        if (grows) {
            lists.append(insert, Range::padded(frame_count), appended, in_first);
            lists.remove_if("record.id % 7u == which", {{"which", appended % 7u}});
            lists.merge(lists.copy());
            (void)lists.device_histogram(10);
        }
        lists.sort(&Item::key);
        lists.sort_by("record.id ^ 5u", Order::descending);
        lists.partial_sort(&Item::id, 4);
        read.run(Range::padded(frame_cells), lists, sums);
        REQUIRE(lists.lengths().total == lists.download().records().size());
        (void)lists.pack();
        (void)lists.pack(&Item::id);
        REQUIRE(lists.validate().ok());
    }

    const Device& device;
    Lists<Item> lists;
    Kernel insert{device, frame_source, "insert", lists};
    Kernel read{device, frame_source, "read", lists};
    Buffer<cl_uint> sums{device, frame_cells};
    cl_uint inserted = frame_count;
    cl_uint in_first = 0;
    bool grows = false;  ///< appends, removes and merges
    cl_uint appended = 100;
};

/// Frames with other data than prepare() saw load no function that it had not loaded.
void require_prepared(Frame& frame, const std::vector<cl_uint>& in_first) {
    const std::set<std::string> functions = loaded_functions();
    for (const cl_uint inserted : {frame_count, 10u, 0u, frame_count})
        for (const cl_uint first : in_first) {
            frame.inserted = inserted;
            frame.in_first = first;
            frame.appended = frame_count - 7u;
            INFO("inserted " << inserted << ", in the first cell " << first);
            frame();
            frame.device.finish();
            for (const std::string& function : loaded_functions()) {
                INFO(function);
                REQUIRE(functions.contains(function));
            }
        }
}

TEST_CASE("after prepare() nothing is compiled, whatever the lengths of the lists") {
    CELLIST_EACH_STORAGE(storage);
    const Device on = Device::choose();
    Frame frame(on, {.storage = storage});
    on.prepare(std::ref(frame));
    // A long list takes as many slots for every cell.
    require_prepared(frame, has_slots(storage) ? std::vector{0u, 300u, 1'000u}
                                               : std::vector{0u, 300u, 5'000u, 150'000u});
}

TEST_CASE("after prepare() nothing is compiled for appends, copies, merges and removals") {
    CELLIST_EACH_STORAGE(storage);
    const Device on = Device::choose();
    // With much room, the prepared appends do not grow the pool, and later ones do.
    const cl_uint capacity = GENERATE(0u, 3 * frame_count);
    Frame frame(on, {.storage = storage, .capacity_nodes = capacity});
    frame.grows = true;
    on.prepare(std::ref(frame));
    require_prepared(frame, {0u, 300u});
}

TEST_CASE("after prepare() sorts by work-groups compile nothing either") {
    const Storage storage = GENERATE(Storage::linked, Storage::counted);
    const Device on = Device::choose();
    Frame frame(on, {.storage = storage});
    frame.lists.core().sorter().set_device_type(CL_DEVICE_TYPE_GPU);
    on.prepare(std::ref(frame));
    require_prepared(frame, {0u, 300u, 5'000u});
}

TEST_CASE("after prepare() nothing is compiled for a pool that is large at once") {
    const Device on = Device::choose();
    Frame frame(on, {.storage = Storage::counted, .capacity_nodes = frame_count});
    on.prepare(std::ref(frame));
    require_prepared(frame, {0u, 150'000u});
}

TEST_CASE("prepare() ends the trial of an automatic storage") {
    const Device on = Device::choose();
    Frame frame(on, {.storage = Storage::automatic});
    on.prepare(std::ref(frame));
    INFO(frame.lists.storage_reason());
    REQUIRE_FALSE(contains(frame.lists.storage_reason(), "on trial"));
    require_prepared(frame, {0u, 150u});
}

TEST_CASE("prepare() counts programs and runs the frame until nothing is new") {
    const Device on = Device::choose();
    int runs = 0;
    std::vector<std::size_t> programs;
    const auto frame = [&] {
        ++runs;
        if (runs > 4) return;
        Kernel(on, "kernel void f(global uint* out) { *out = " + std::to_string(runs) + "; }", "f");
    };
    on.prepare(frame, [&](std::size_t made) { programs.push_back(made); });
    REQUIRE(programs == std::vector<std::size_t>{1, 2, 3, 4});
    REQUIRE(runs == 5);
    on.prepare([&] { ++runs; });
    REQUIRE(runs == 7);
}

TEST_CASE("prepare() ends for frames that never stop to compile") {
    const Device on = Device::choose();
    int runs = 0;
    on.prepare([&] {
        Kernel(on, "kernel void f(global uint* out) { *out = 8" + std::to_string(++runs) + "; }",
               "f");
    });
    REQUIRE(runs >= 2);
    REQUIRE(runs <= 64);
}

TEST_CASE("prepare() throws what the frame throws, and can be called again") {
    const Device on = Device::choose();
    REQUIRE_THROWS_AS(on.prepare([] { throw std::runtime_error("frame"); }), std::runtime_error);
    const auto nested = [&] { on.prepare([&] { on.prepare([] {}); }); };
    REQUIRE(contains(error_of(nested).what(), "prepare()"));
    const auto make = [&] { Kernel(on, "kernel void f(global uint* out) { *out = 77; }", "f"); };
    REQUIRE_THROWS_AS(on.prepare(make, [](std::size_t) { throw std::runtime_error("progress"); }),
                      std::runtime_error);
    on.prepare(make);
}

TEST_CASE("lists are sorted and sound after prepare()") {
    CELLIST_EACH_STORAGE(storage);
    Frame frame(device(), {.storage = storage});
    frame.in_first = 300;
    device().prepare(std::ref(frame));
    for (int i = 0; i < 2; ++i) {
        frame.lists.build(frame.insert, Range::padded(frame_count), frame_count, cl_uint{1000});
        frame.lists.sort(&Item::key);
        const HostLists<Item> found = frame.lists.download();
        REQUIRE(found.records().size() == frame_count);
        for (std::uint64_t cell = 0; cell < frame_cells; ++cell)
            REQUIRE(std::is_sorted(found.cell(cell).begin(), found.cell(cell).end(),
                                   [](const Item& a, const Item& b) {
                                       return a.key < b.key || (a.key == b.key && a.id < b.id);
                                   }));
        device().prepare([&] { frame.lists.sort(&Item::key); });
        REQUIRE(frame.lists.validate().ok());
        REQUIRE(frame.lists.download().records() == found.records());
    }
}

}  // namespace
}  // namespace cellist::test
