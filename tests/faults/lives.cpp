// SPDX-License-Identifier: MIT
// Work that makes all objects that it needs, from the first to the last.
#include <optional>
#include <utility>

#include "checks.hpp"
#include "layer.hpp"

namespace cellist::test {
namespace {

/// From the first object to the last.
void live_on(const Device& device, Storage storage) {
    const Inserts<Item> inserts = scene_inserts();
    const Oracle<Item> oracle = oracle_of(inserts, cell_count);
    Kernel insert(device, scene_source(), "insert", type<Item>);
    const Buffer<cl_uint> cells(device, inserts.cells);
    const Buffer<Item> records(device, inserts.records);
    Lists<Item> lists(device, {cell_count},
                      scene_options(device, storage, Room::too_little, Overflow::grow));
    require_all_stored(lists.build(insert, insert_range(), cells, records, insert_count), oracle);
    require_lengths(lists.lengths(), oracle);
    require_packed(lists.pack(), oracle);
    lists.sort_by_async("record.id");
    require_sorted(lists.download(), oracle, by_id);
    require_sound(lists.validate());
    lists.clear();
    require(Contents::empty, lists, oracle);
}

/// Prepares a frame that builds and sorts.
void prepare(const Device& device, Storage storage) {
    const Inserts<Item> inserts = scene_inserts();
    const Oracle<Item> oracle = oracle_of(inserts, cell_count);
    Kernel insert(device, scene_source(), "insert", type<Item>);
    const Buffer<cl_uint> cells(device, inserts.cells);
    const Buffer<Item> records(device, inserts.records);
    Lists<Item> lists(device, {cell_count},
                      scene_options(device, storage, Room::enough, Overflow::grow));
    device.prepare([&] {
        require_all_stored(lists.build(insert, insert_range(), cells, records, insert_count),
                           oracle);
        lists.sort(&Item::id);
    });
    // A sort that lacks memory works like this one: its program is kept before anything fails.
    lists.sort_async(&Item::id);
    require_sorted(lists.download(), oracle, by_id);
    require_sound(lists.validate());
}

/// A new device. It goes while no call fails: the destructor waits for the queue, and nobody learns
/// whether that failed.
struct NewDevice {
    explicit NewDevice(Device made) : device(std::move(made)) {}
    NewDevice(const NewDevice&) = delete;
    NewDevice& operator=(const NewDevice&) = delete;
    ~NewDevice() {
        const faults::Pause pause;
        device.reset();
    }
    std::optional<Device> device;
};

void live_on_a_new_device(const Device&, Storage storage) {
    live_on(*NewDevice(Device::choose()).device, storage);
}

void make_a_device(const Device&, Storage) { NewDevice(Device::choose()).device->finish(); }

void choose_by_name(const Device& device, Storage) {
    const std::string& name = device.info().name;
    const NewDevice chosen(Device::choose(name));
    REQUIRE(chosen.device->info().name == name);
    const std::vector<DeviceInfo> all = Device::all();
    REQUIRE_FALSE(all.empty());
}

void adopt_a_queue(const Device& device, Storage) {
    std::optional<cl::Context> context;
    std::optional<cl::CommandQueue> queue;
    {
        const faults::Pause pause;
        context = device.context();
        queue = device.queue();
    }
    Device(std::move(*context), std::move(*queue)).finish();
}

constexpr Life table_of_lives[] = {
    {"make a device", make_a_device},
    {"choose a device by name", choose_by_name},
    {"adopt a queue", adopt_a_queue},
    {"everything, on a device in use", live_on},
    {"everything, on a new device", live_on_a_new_device, 151},
    {"prepare, on a device in use", prepare, 13, true},
};

}  // namespace

std::span<const Life> lives() { return table_of_lives; }

}  // namespace cellist::test
