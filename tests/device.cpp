// SPDX-License-Identifier: MIT
// Devices are chosen by index and by name, and everything made from a Device outlives it.
#include <cctype>
#include <cstdlib>

#include "support/errors.hpp"
#include "support/inserts.hpp"

namespace cellist::test {
namespace {

std::string with_case(std::string text, int (*convert)(int)) {
    for (char& c : text) c = static_cast<char>(convert(static_cast<unsigned char>(c)));
    return text;
}

TEST_CASE("devices are chosen by their index") {
    const std::vector<DeviceInfo> all = Device::all();
    REQUIRE_FALSE(all.empty());
    for (std::size_t i = 0; i < all.size(); ++i) {
        const Device chosen = Device::choose(std::to_string(i));
        REQUIRE(chosen.info().name == all[i].name);
        REQUIRE(chosen.info().platform == all[i].platform);
    }
}

TEST_CASE("devices are chosen by a part of their name or platform, without regard to case") {
    for (const DeviceInfo& info : Device::all())
        for (const std::string& name : {info.name, info.platform})
            for (const std::string& selector :
                 {name, with_case(name, std::toupper), with_case(name, std::tolower),
                  name.substr(name.size() / 2), name.substr(0, name.size() / 2 + 1)}) {
                if (std::all_of(selector.begin(), selector.end(),
                                [](unsigned char c) { return std::isdigit(c); }))
                    continue;
                INFO("selector " << selector);
                const Device chosen = Device::choose(selector);
                const std::string names =
                    with_case(chosen.info().name + "\n" + chosen.info().platform, std::tolower);
                REQUIRE(contains(names, with_case(selector, std::tolower)));
            }
}

TEST_CASE("an unknown device is an error that lists the devices") {
    for (const char* selector : {"no such device", "999999", "-1", "0x0", ""}) {
        INFO("selector '" << selector << "'");
        const auto error = error_of([&] { (void)Device::choose(selector); });
        INFO(error.what());
        REQUIRE(contains(error.what(), selector));
        for (const DeviceInfo& info : Device::all()) REQUIRE(contains(error.what(), info.name));
    }
}

TEST_CASE("a device describes itself") {
    for (const DeviceInfo& info : Device::all()) {
        INFO(info.name);
        REQUIRE_FALSE(info.name.empty());
        REQUIRE_FALSE(info.platform.empty());
        REQUIRE(contains(info.version, "OpenCL"));
        REQUIRE_FALSE(info.driver.empty());
        REQUIRE(info.global_memory_bytes >= info.max_allocation_bytes);
        REQUIRE(info.max_allocation_bytes > 0);
        REQUIRE(info.local_memory_bytes > 0);
        REQUIRE(info.compute_units > 0);
        REQUIRE(info.max_work_group_size > 0);
        REQUIRE(info.type != 0);
    }
}

TEST_CASE("containers, kernels and buffers outlive the Device object") {
    CELLIST_RANDOM(random, 140u);
    std::optional<Device> own = Device::choose();
    Lists<Item> lists(*own, {50}, {.capacity_nodes = 1});
    Kernel kernel(*own, insert_source("Item"), "insert_all", lists);
    const Inserts<Item> inserts = random_inserts(144, 50, random);
    const Buffer<cl_uint> cells(*own, inserts.cells);
    const Buffer<Item> records(*own, inserts.records);
    own.reset();
    require_complete(lists.build(kernel, 144, cells, records, cl_uint{144}), 144);
    lists.sort(&Item::key);
    require_sound(lists, 144);
    require_same(lists.download(), oracle_of(inserts, 50));
    REQUIRE(cells.download() == inserts.cells);
}

TEST_CASE("the last object of a device waits for the work in its queue") {
    // Long enough that nothing but waiting sees the end of it.
    constexpr const char* source = R"(
kernel void advance(global uint* value, uint steps)
{
    uint x = value[0];
    for (uint i = 0; i < steps; ++i) x = x * 1664525u + 1013904223u;
    value[0] = x;
}
)";
    cl::Event end;
    {
        const Device own = Device::choose();
        const Buffer<cl_uint> value(own, 1);
        Kernel advance(own, source, "advance");
        for (int i = 0; i < 20; ++i) advance.run(1, value, cl_uint{5'000'000});
        end = own.enqueue_marker();
    }
    REQUIRE(end.getInfo<CL_EVENT_COMMAND_EXECUTION_STATUS>() == CL_COMPLETE);
}

TEST_CASE("moved devices, containers, kernels and buffers go on working") {
    static_assert(!std::is_copy_constructible_v<Device> && !std::is_copy_assignable_v<Device>);
    static_assert(!std::is_copy_constructible_v<Lists<Item>> &&
                  !std::is_copy_assignable_v<Lists<Item>>);
    static_assert(!std::is_copy_constructible_v<Kernel> && !std::is_copy_assignable_v<Kernel>);
    static_assert(!std::is_copy_constructible_v<Buffer<cl_uint>> &&
                  !std::is_copy_assignable_v<Buffer<cl_uint>>);

    CELLIST_RANDOM(random, 141u);
    Device first = Device::choose();
    Device own = std::move(first);
    const Inserts<Item> inserts = random_inserts(144, 50, random);
    Lists<Item> old_lists(own, {50}, {.capacity_nodes = 1});
    Kernel old_kernel(own, insert_source("Item"), "insert_all", old_lists);
    Buffer<cl_uint> old_cells(own, inserts.cells);
    Buffer<Item> old_records(own, inserts.records);
    old_lists.sort(&Item::key);

    Lists<Item> lists = std::move(old_lists);
    Kernel kernel = std::move(old_kernel);
    const Buffer<cl_uint> cells = std::move(old_cells);
    Buffer<Item> records(own, 0);
    records = std::move(old_records);
    REQUIRE(records.size() == 144);
    require_complete(lists.build(kernel, 144, cells, records, cl_uint{144}), 144);

    Lists<Item> assigned(own, {3});
    assigned = std::move(lists);
    kernel = Kernel(own, insert_source("Item"), "insert_all", assigned);
    assigned.sort(&Item::key);
    require_sound(assigned, 144);
    require_same(assigned.download(), oracle_of(inserts, 50));
    require_complete(assigned.build(kernel, 144, cells, records, cl_uint{144}), 144);

    own = Device::choose();
    require_same(assigned.download(), oracle_of(inserts, 50));
}

}  // namespace
}  // namespace cellist::test
