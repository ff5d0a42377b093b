#include "operations.hpp"

#include <algorithm>
#include <optional>

#include "layer.hpp"
#include "support/storages.hpp"

namespace cellist::test {
namespace {

constexpr cl_uint cell_count = 17;
constexpr cl_uint insert_count = 93;

// No #include: it would only be searched for.
constexpr auto source = R"(
kernel void insert(CELLIST_LISTS(Item, lists), global const uint* cells, global const Item* records,
                   uint count)
{
    const uint i = get_global_id(0);
    if (i < count) cellist_insert(lists, cells[i], records[i]);
}

kernel void insert_both(CELLIST_LISTS(Item, a), CELLIST_LISTS(Item, b), global const uint* cells,
                        global const Item* records, uint count)
{
    const uint i = get_global_id(0);
    if (i >= count) return;
    cellist_insert(a, cells[i], records[i]);
    cellist_insert(b, cells[i], records[i]);
}

// The number of records in each cell and the sum of their ids.
kernel void read(CELLIST_LISTS(Item, lists), global uint2* sums)
{
    const uint cell = get_global_id(0);
    if (cell >= cellist_cells(lists)) return;
    uint2 sum = 0;
    cellist_for_each(lists, cell, node) sum += (uint2)(1, cellist_get(lists, node).id);
    sums[cell] = sum;
}
)";

ListsOptions options_of(Storage storage, Room room, Overflow overflow) {
    constexpr std::uint64_t capacities[] = {0, insert_count / 3, 2 * insert_count};
    constexpr std::uint32_t slots[] = {0, 1, insert_count};
    const auto index = static_cast<std::size_t>(room);
    return {.storage = storage,
            .overflow = overflow,
            .capacity_nodes = capacities[index],
            .slots = slots[index]};
}

/// The first items are outside of the shape.
Inserts<Item> items() {
    std::mt19937 random(301);
    Inserts<Item> inserts = random_inserts(insert_count, cell_count, random);
    std::fill_n(inserts.cells.begin(), 3, cell_count);
    return inserts;
}

Storage next(Storage storage) {
    const auto found = std::find(all_storages.begin(), all_storages.end(), storage);
    return found + 1 == all_storages.end() ? all_storages.front() : *(found + 1);
}

Range range() { return Range::padded(insert_count, 32); }

/// The records of a cell, ordered by the key and then by the id, or by the id alone.
std::vector<Item> in_order(const Oracle<Item>& oracle, std::uint64_t cell, auto before) {
    std::vector<Item> list;
    const auto [begin, end] = oracle.equal_range(cell);
    for (auto entry = begin; entry != end; ++entry) list.push_back(entry->second);
    std::sort(list.begin(), list.end(), before);
    return list;
}

/// What lists hold, without faults.
HostLists<Item> contents_of(const Lists<Item>& lists) {
    const faults::Pause pause;
    return lists.download();
}

void require_sorted(const HostLists<Item>& found, const Oracle<Item>& oracle, auto before) {
    for (std::uint64_t cell = 0; cell < cell_count; ++cell) {
        const auto list = found.cell(cell);
        const std::vector<Item> expected = in_order(oracle, cell, before);
        REQUIRE(std::equal(list.begin(), list.end(), expected.begin(), expected.end()));
    }
}

void require_packed(const Packed<Item>& packed, const Oracle<Item>& oracle) {
    const faults::Pause pause;
    std::vector<std::uint64_t> offsets;
    for (const cl_uint offset : packed.offsets.download()) offsets.push_back(offset);
    REQUIRE(offsets.size() == cell_count + 1);
    require_same(HostLists<Item>({cell_count}, std::move(offsets), packed.records.download()),
                 oracle);
}

void require_lengths(const Lengths& lengths, const Oracle<Item>& oracle) {
    std::map<std::uint64_t, std::uint64_t> histogram;
    for (std::uint64_t cell = 0; cell < cell_count; ++cell) ++histogram[oracle.count(cell)];
    REQUIRE(lengths.histogram == histogram);
    REQUIRE(lengths.total == oracle.size());
    REQUIRE(lengths.longest == histogram.rbegin()->first);
}

void require_sound(const Validation& validation) {
    if (!validation.ok()) FAIL(validation.message());
}

void require(Contents contents, const Lists<Item>& lists, const Oracle<Item>& oracle) {
    const faults::Pause pause;
    require_sound(lists.validate());
    require_same(lists.download(), contents == Contents::full ? oracle : Oracle<Item>());
}

void require_all_stored(const BuildReport& report, const Oracle<Item>& oracle) {
    require_complete(report, oracle.size(), insert_count - oracle.size());
}

void clear(Scene& scene) {
    scene.lists_hold = Contents::empty;
    scene.lists.clear();
}

void sort_by_a_member(Scene& scene) {
    scene.lists.sort(&Item::key);
    require_sorted(contents_of(scene.lists), scene.oracle, [](const Item& a, const Item& b) {
        return a.key != b.key ? a.key < b.key : a.id < b.id;
    });
}

void sort_by_an_expression(Scene& scene) {
    scene.lists.sort_by("record.id % 10", Order::descending);
    require_sorted(contents_of(scene.lists), scene.oracle, [](const Item& a, const Item& b) {
        if (a.id % 10 != b.id % 10) return a.id % 10 > b.id % 10;
        return a.key != b.key ? a.key < b.key : a.id < b.id;
    });
}

void build_both(Scene& scene) {
    scene.uses_other = true;
    scene.lists_hold = scene.other_holds = Contents::empty;
    const auto [report, other] = cellist::build(
        [&] {
            scene.insert_both.run(range(), scene.lists, scene.other, scene.cells, scene.records,
                                  insert_count);
        },
        scene.lists, scene.other);
    scene.lists_hold = scene.other_holds = Contents::full;
    require_all_stored(report, scene.oracle);
    require_all_stored(other, scene.oracle);
}

void stop(Scene& scene) {
    scene.overflowed = false;
    std::optional<OverflowError> error;
    try {
        scene.build();
    } catch (const OverflowError& caught) {
        error = caught;
    }
    REQUIRE(error.has_value());
    scene.overflowed = true;
    const BuildReport& report = error->report();
    REQUIRE(report.stored + report.dropped == scene.oracle.size());
    REQUIRE(report.rejected == insert_count - scene.oracle.size());
    // The room is that of the options, whatever went wrong in earlier builds.
    REQUIRE(report.capacity_nodes == (scene.options.storage == Storage::fixed
                                          ? *scene.options.slots * std::uint64_t{cell_count}
                                          : *scene.options.capacity_nodes));
}

void run_a_reader(Scene& scene) {
    const Buffer<cl_uint2> sums(device(), cell_count);
    scene.read.run(Range::padded(cell_count, 32), scene.lists, sums);
    const std::vector<cl_uint2> found = sums.download();
    for (cl_uint cell = 0; cell < cell_count; ++cell) {
        cl_uint2 expected{{0, 0}};
        const auto [begin, end] = scene.oracle.equal_range(cell);
        for (auto entry = begin; entry != end; ++entry) {
            ++expected.s[0];
            expected.s[1] += entry->second.id;
        }
        REQUIRE(found[cell].s[0] == expected.s[0]);
        REQUIRE(found[cell].s[1] == expected.s[1]);
    }
}

void use_buffers(Scene& scene) {
    Buffer<Item> buffer(device(), scene.inserts.records);
    std::vector<Item> found = buffer.download();
    REQUIRE(found == scene.inserts.records);
    buffer.fill({2.0f, 5});
    found = buffer.download();
    REQUIRE(found == std::vector<Item>(insert_count, {2.0f, 5}));
    struct Three {
        cl_uchar bytes[3];
    };
    Buffer<Three> odd(device(), 7);
    odd.fill({{1, 2, 3}});
    const std::vector<Three> last = odd.download();
    REQUIRE(last[6].bytes[2] == 3);
    device().finish();
}

/// From the first object to the last.
void live_on(const Device& device, Storage storage) {
    const Inserts<Item> inserts = items();
    const Oracle<Item> oracle = oracle_of(inserts, cell_count);
    Kernel insert(device, source, "insert", type<Item>);
    const Buffer<cl_uint> cells(device, inserts.cells);
    const Buffer<Item> records(device, inserts.records);
    Lists<Item> lists(device, {cell_count}, options_of(storage, Room::too_little, Overflow::grow));
    require_all_stored(lists.build(insert, range(), cells, records, insert_count), oracle);
    require_lengths(lists.lengths(), oracle);
    require_packed(lists.pack(), oracle);
    lists.sort_by("record.id");
    require_sorted(lists.download(), oracle,
                   [](const Item& a, const Item& b) { return a.id < b.id; });
    require_sound(lists.validate());
    lists.clear();
    require(Contents::empty, lists, oracle);
}

void live_on_a_used_device(Storage storage) { live_on(device(), storage); }

void live_on_a_new_device(Storage storage) { live_on(Device::choose(), storage); }

void make_a_device(Storage) { Device::choose().finish(); }

void adopt_a_queue(Storage) {
    std::optional<cl::Context> context;
    std::optional<cl::CommandQueue> queue;
    {
        const faults::Pause pause;
        context = device().context();
        queue = device().queue();
    }
    Device(std::move(*context), std::move(*queue)).finish();
}

void choose_by_name(Storage) {
    const std::string& name = device().info().name;
    const Device chosen = Device::choose(name);
    REQUIRE(chosen.info().name == name);
    const std::vector<DeviceInfo> all = Device::all();
    REQUIRE_FALSE(all.empty());
    chosen.finish();
}

constexpr auto empty = Contents::empty;
constexpr auto full = Contents::full;

constexpr Operation table[] = {
    {"make a container", full,
     [](Scene& s) { require(empty, Lists<Item>(device(), {cell_count}, s.options), s.oracle); }},
    {"make a kernel", full, [](Scene& s) { Kernel(device(), source, "insert", s.lists); }},
    {"buffers", full, use_buffers},
    {"build", empty, [](Scene& s) { s.build(); }},
    {"build over full lists", full, [](Scene& s) { s.build(); }},
    {"build that grows", empty, [](Scene& s) { s.build(); }, Room::none},
    {"build that may drop", empty, [](Scene& s) { s.build(); }, Room::enough, Overflow::drop},
    {"build that may stop", empty, [](Scene& s) { s.build(); }, Room::enough, Overflow::stop},
    {"build that stops", empty, stop, Room::too_little, Overflow::stop},
    {"build two containers", empty, build_both},
    {"build two containers that grow", empty, build_both, Room::too_little},
    {"clear", full, clear},
    {"sort by a member", full, sort_by_a_member},
    {"sort by an expression", full, sort_by_an_expression},
    {"lengths", full, [](Scene& s) { require_lengths(s.lists.lengths(), s.oracle); }},
    {"pack", full, [](Scene& s) { require_packed(s.lists.pack(), s.oracle); }},
    {"download", full, [](Scene& s) { require_same(s.lists.download(), s.oracle); }},
    {"validate", full, [](Scene& s) { require_sound(s.lists.validate()); }},
    {"read in a kernel", full, run_a_reader},
};

constexpr Life table_of_lives[] = {
    {"make a device", make_a_device},
    {"choose a device by name", choose_by_name},
    {"adopt a queue", adopt_a_queue},
    {"everything, on a device in use", live_on_a_used_device},
    {"everything, on a new device", live_on_a_new_device, 61},
};

}  // namespace

Scene::Scene(Storage storage, const Operation& operation)
    : options(options_of(storage, operation.room, operation.overflow)),
      inserts(items()),
      oracle(oracle_of(inserts, cell_count)),
      cells(device(), inserts.cells),
      records(device(), inserts.records),
      lists(device(), {cell_count}, options),
      other(device(), {cell_count}, options_of(next(storage), operation.room, operation.overflow)),
      insert(device(), source, "insert", lists),
      insert_both(device(), source, "insert_both", lists, other),
      read(device(), source, "read", lists) {
    if (operation.before == Contents::full) build();
}

void Scene::build() {
    lists_hold = Contents::empty;
    const BuildReport report = lists.build(insert, range(), cells, records, insert_count);
    lists_hold = Contents::full;
    require_all_stored(report, oracle);
}

void Scene::require_contents() const {
    require(lists_hold, lists, oracle);
    if (uses_other) require(other_holds, other, oracle);
}

std::span<const Operation> operations() { return table; }
std::span<const Life> lives() { return table_of_lives; }

}  // namespace cellist::test
