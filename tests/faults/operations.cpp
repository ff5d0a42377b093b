#include "operations.hpp"

#include <algorithm>
#include <optional>

#include "layer.hpp"
#include "support/internals.hpp"
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

Range range() { return Range::padded(insert_count, 32); }

ListsOptions options_of(const Device& device, Storage storage, Room room, Overflow overflow,
                        bool automatic = false) {
    ListsOptions options{.storage = automatic ? Storage::automatic : storage, .overflow = overflow};
    if (overflow == Overflow::keep_nearest) {
        options.storage = Storage::fixed;
        options.nearest_by = "key";
    }
    options.capacity_nodes = room == Room::enough       ? 2 * insert_count
                             : room == Room::too_little ? insert_count / 3
                                                        : 0;
    options.slots = room == Room::enough ? insert_count : room == Room::too_little ? 1 : 0;
    if (room == Room::for_a_part)
        options.budget_bytes = Lists<Item>(device, {cell_count}, options).pool_bytes() + 600;
    return options;
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

// ---- what results must be ------------------------------------------------------------------------
// No INFO in here: it would outlive each OpenCL error that passes it.

void require_all_stored(const BuildReport& report, const Oracle<Item>& oracle) {
    require_complete(report, oracle.size(), insert_count - oracle.size());
}

std::vector<Item> in_order(const Oracle<Item>& oracle, std::uint64_t cell, auto before) {
    std::vector<Item> list;
    const auto [begin, end] = oracle.equal_range(cell);
    for (auto entry = begin; entry != end; ++entry) list.push_back(entry->second);
    std::sort(list.begin(), list.end(), before);
    return list;
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

void require_packed_ids(const Packed<cl_uint>& packed, const Oracle<Item>& oracle) {
    const faults::Pause pause;
    std::vector<cl_uint> found = packed.records.download();
    std::vector<cl_uint> expected;
    for (const auto& [cell, item] : oracle) expected.push_back(item.id);
    std::sort(found.begin(), found.end());
    std::sort(expected.begin(), expected.end());
    REQUIRE(found == expected);
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

HostLists<Item> contents_of(const Lists<Item>& lists) {
    const faults::Pause pause;
    return lists.download();
}

// ---- operations ----------------------------------------------------------------------------------

void make_a_container(Scene& scene) {
    const Lists<Item> lists(scene.device, {cell_count}, scene.options);
    require(Contents::empty, lists, scene.oracle);
}

void make_a_kernel(Scene& scene) { Kernel(scene.device, source, "insert", scene.lists); }

void use_buffers(Scene& scene) {
    Buffer<Item> buffer(scene.device, scene.inserts.records);
    std::vector<Item> found = buffer.download();
    REQUIRE(found == scene.inserts.records);
    buffer.fill({2.0f, 5});
    found = buffer.download_async().get();
    REQUIRE(found == std::vector<Item>(insert_count, {2.0f, 5}));
    buffer.upload_async(scene.inserts.records);
    scene.device.finish();
    found = buffer.download();
    REQUIRE(found == scene.inserts.records);
    struct Three {
        cl_uchar bytes[3];
    };
    Buffer<Three> odd(scene.device, 7);
    odd.fill({{1, 2, 3}});
    const std::vector<Three> last = odd.download();
    REQUIRE(last[6].bytes[2] == 3);
}

void wait_for_events(Scene& scene) {
    std::vector<cl::Event> events;
    events.push_back(scene.device.enqueue_marker());
    scene.device.enqueue_wait(events);
    scene.device.finish();
}

void build(Scene& scene) { scene.build(); }

/// Memory that an operation can do without may be missing in silence.
void forgive_missing_memory(Scene& scene) {
    for (const faults::Fault& fault : faults::failures())
        scene.silent = fault.code == CL_MEM_OBJECT_ALLOCATION_FAILURE ||
                       fault.code == CL_OUT_OF_RESOURCES || fault.code == CL_OUT_OF_HOST_MEMORY;
}

void build_automatic(Scene& scene) {
    scene.build();
    forgive_missing_memory(scene);
}

Pending<BuildReport> start_build(Scene& scene) {
    scene.lists_hold = Contents::empty;
    return scene.lists.build_async(scene.insert, range(), scene.cells, scene.records, insert_count);
}

void build_later(Scene& scene) {
    Pending<BuildReport> pending = start_build(scene);
    scene.lists_hold = Contents::full;  // what reads them finishes the build
    (void)pending.ready();
    scene.lists_hold = Contents::empty;
    const BuildReport report = pending.get();
    scene.lists_hold = Contents::full;
    require_all_stored(report, scene.oracle);
}

/// A build, and something that reads its lists before its report. Where that fails, the report tells
/// what was done before.
auto build_later_and(Scene& scene, const auto& read) {
    Pending<BuildReport> pending = start_build(scene);
    auto found = [&] {
        try {
            return read();
        } catch (const OpenClError&) {
            const faults::Pause pause;
            try {
                require_all_stored(pending.get(), scene.oracle);
                scene.lists_hold = Contents::full;
            } catch (const OpenClError&) {}
            throw;
        }
    }();
    // Under drop, the build itself may fail even now; its lists are empty then.
    require_all_stored(pending.get(), scene.oracle);
    scene.lists_hold = Contents::full;
    return found;
}

void build_later_and_read(Scene& scene) {
    require_same(build_later_and(scene, [&] { return scene.lists.download(); }), scene.oracle);
}

void build_later_and_validate(Scene& scene) {
    require_sound(build_later_and(scene, [&] { return scene.lists.validate(); }));
}

/// Under drop the copy has room for the whole pool, whose rest holds anything.
void build_later_and_pack(Scene& scene) {
    const Packed<Item> packed = build_later_and(scene, [&] { return scene.lists.pack(); });
    const faults::Pause pause;
    const std::vector<cl_uint> offsets = packed.offsets.download();
    std::vector<Item> records = packed.records.download();
    REQUIRE(records.size() == scene.lists.capacity_nodes());
    REQUIRE(offsets.back() == scene.oracle.size());
    records.resize(offsets.back());
    require_same(HostLists<Item>({cell_count}, {offsets.begin(), offsets.end()}, records),
                 scene.oracle);
}

void abandon_a_build(Scene& scene) {
    Lists<Item> lists(scene.device, {cell_count}, scene.options);
    const Pending<BuildReport> pending =
        lists.build_async(scene.insert, range(), scene.cells, scene.records, insert_count);
    scene.silent = faults::failures().empty();
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

void build_both_later(Scene& scene) {
    scene.uses_other = true;
    scene.lists_hold = scene.other_holds = Contents::empty;
    auto pending = cellist::build_async(
        [&] {
            scene.insert_both.run(range(), scene.lists, scene.other, scene.cells, scene.records,
                                  insert_count);
        },
        scene.lists, scene.other);
    const auto [report, other] = pending.get();
    scene.lists_hold = scene.other_holds = Contents::full;
    require_all_stored(report, scene.oracle);
    require_all_stored(other, scene.oracle);
}

/// A kernel of the build reads a container that is no part of it.
void build_beside_another(Scene& scene) {
    const Buffer<cl_uint2> sums(scene.device, cell_count);
    scene.lists_hold = Contents::empty;
    const BuildReport report = scene.lists.build([&] {
        scene.insert.run(range(), scene.lists, scene.cells, scene.records, insert_count);
        scene.read.run(Range::padded(cell_count, 32), scene.other, sums);
    });
    scene.lists_hold = Contents::full;
    require_all_stored(report, scene.oracle);
}

/// A kernel on another queue of the context. It stays for all tests.
Kernel& insert_on_another_queue(const Scene& scene) {
    const faults::Pause pause;
    static Kernel* const kernel = [&] {
        const cl::Device device = scene.device.context().getInfo<CL_CONTEXT_DEVICES>().front();
        const Device user(scene.device.context(), cl::CommandQueue(scene.device.context(), device));
        return new Kernel(user, source, "insert", type<Item>);
    }();
    return * kernel;
}

void build_by_another_queue(Scene& scene) {
    Kernel& insert = insert_on_another_queue(scene);
    scene.lists_hold = Contents::empty;
    const BuildReport report =
        scene.lists.build(insert, range(), scene.cells, scene.records, insert_count);
    scene.lists_hold = Contents::full;
    require_all_stored(report, scene.oracle);
}

void build_and_stop(Scene& scene) {
    std::optional<OverflowError> error;
    try {
        scene.build();
    } catch (const OverflowError& caught) {
        error = caught;
    }
    REQUIRE(error.has_value());
    scene.silent = true;
    const BuildReport& report = error->report();
    REQUIRE(report.stored + report.dropped == scene.oracle.size());
    REQUIRE(report.rejected == insert_count - scene.oracle.size());
    // The room is that of the options, whatever went wrong in earlier builds.
    REQUIRE(report.capacity_nodes == (scene.options.storage == Storage::fixed
                                          ? *scene.options.slots * std::uint64_t{cell_count}
                                          : *scene.options.capacity_nodes));
}

void build_slices(Scene& scene) {
    scene.lists_hold = Contents::empty;
    Oracle<Item> found;
    std::uint64_t slices = 0;
    const BuildReport report = scene.lists.build_slices(
        [&] { scene.insert.run(range(), scene.lists, scene.cells, scene.records, insert_count); },
        [&](const Slice& slice) {
            const HostLists<Item> lists = scene.lists.download();
            for (std::uint64_t i = 0; i < slice.cells; ++i)
                for (const Item& item : lists.cell(slice.first_cell + i))
                    found.emplace(slice.first_cell + i, item);
            ++slices;
        });
    REQUIRE(report.stored == scene.oracle.size());
    REQUIRE(slices > 1);
    REQUIRE(found.size() == scene.oracle.size());
    for (std::uint64_t cell = 0; cell < cell_count; ++cell) {
        const auto by_id = [](const Item& a, const Item& b) { return a.id < b.id; };
        REQUIRE(in_order(found, cell, by_id) == in_order(scene.oracle, cell, by_id));
    }
}

void clear(Scene& scene) {
    scene.lists_hold = Contents::empty;
    scene.lists.clear();
}

bool by_key(const Item& a, const Item& b) { return a.key != b.key ? a.key < b.key : a.id < b.id; }

/// The device keeps the programs that it builds. This one is for lists without memory for a second pool.
void keep_program_without_second_pool(Scene& scene, auto sort_async) {
    const faults::Pause pause;
    Lists<Item> lists(scene.device, {1}, {.storage = scene.options.storage});
    sort_async(lists);
}

void sort_by_a_member(Scene& scene) {
    keep_program_without_second_pool(scene, [](auto& lists) { lists.sort_async(&Item::key); });
    scene.lists.sort(&Item::key);
    forgive_missing_memory(scene);
    require_sorted(contents_of(scene.lists), scene.oracle, by_key);
}

void sort_by_an_expression(Scene& scene) {
    keep_program_without_second_pool(
        scene, [](auto& lists) { lists.sort_by_async("record.id % 10", Order::descending); });
    scene.lists.sort_by("record.id % 10", Order::descending);
    forgive_missing_memory(scene);
    require_sorted(contents_of(scene.lists), scene.oracle, [](const Item& a, const Item& b) {
        if (a.id % 10 != b.id % 10) return a.id % 10 > b.id % 10;
        return by_key(a, b);
    });
}

void sort_without_blocking(Scene& scene) {
    scene.lists.sort_async(&Item::key);
    require_sorted(contents_of(scene.lists), scene.oracle, by_key);
}

/// A list of more records than are ranked together. Whatever fails, it keeps them.
void sort_a_long_list(Scene& scene) {
    constexpr cl_uint repeats = 4;
    std::optional<Lists<Item>> lists;
    std::vector<Item> expected;
    const auto found = [&] {
        const faults::Pause pause;
        require_sound(lists->validate());
        const HostLists<Item> host = lists->download();
        return std::vector<Item>(host.records().begin(), host.records().end());
    };
    {
        const faults::Pause pause;
        lists.emplace(scene.device, Shape{1}, ListsOptions{.storage = scene.options.storage});
        Buffer<cl_uint> cells(scene.device, insert_count);
        cells.fill(0);
        lists->build([&] {
            for (cl_uint i = 0; i < repeats; ++i)
                scene.insert.run(range(), *lists, cells, scene.records, insert_count);
        });
        for (cl_uint i = 0; i < repeats; ++i)
            expected.insert(expected.end(), scene.inserts.records.begin(),
                            scene.inserts.records.end());
        std::sort(expected.begin(), expected.end(), by_key);
    }
    keep_program_without_second_pool(scene, [](auto& own) { own.sort_async(&Item::key); });
    try {
        lists->sort(&Item::key);
    } catch (const OpenClError&) {
        std::vector<Item> kept = found();
        std::sort(kept.begin(), kept.end(), by_key);
        REQUIRE(kept == expected);
        throw;
    }
    forgive_missing_memory(scene);
    REQUIRE(found() == expected);
}

void lengths(Scene& scene) { require_lengths(scene.lists.lengths(), scene.oracle); }
void pack(Scene& scene) { require_packed(scene.lists.pack(), scene.oracle); }
void pack_a_member(Scene& scene) { require_packed_ids(scene.lists.pack(&Item::id), scene.oracle); }
void download(Scene& scene) { require_same(scene.lists.download(), scene.oracle); }
void validate(Scene& scene) { require_sound(scene.lists.validate()); }

/// Three results are on their way at once.
void read_later(Scene& scene) {
    Pending<HostLists<Item>> lists = scene.lists.download_async();
    Pending<Lengths> lengths = scene.lists.lengths_async();
    Pending<Validation> validation = scene.lists.validate_async();
    require_same(lists.get(), scene.oracle);
    require_lengths(lengths.get(), scene.oracle);
    require_sound(validation.get());
}

void read_in_a_kernel(Scene& scene) {
    const Buffer<cl_uint2> sums(scene.device, cell_count);
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

constexpr auto empty = Contents::empty;
constexpr auto full = Contents::full;
constexpr auto first = Use::first;
constexpr auto repeated = Use::repeated;

constexpr Operation table[] = {
    {"make a container", empty, make_a_container},
    {"make a kernel", empty, make_a_kernel},
    {"use buffers", empty, use_buffers},
    {"wait for events", empty, wait_for_events},
    {"build", empty, build},
    {"build over full lists", full, build, repeated},
    {"build that grows", empty, build, first, Room::none},
    {"build that may drop", empty, build, repeated, Room::enough, Overflow::drop},
    {"build that may stop", empty, build, repeated, Room::enough, Overflow::stop},
    {"build that stops", empty, build_and_stop, repeated, Room::too_little, Overflow::stop},
    {"build that keeps the nearest", empty, build, repeated, Room::enough, Overflow::keep_nearest},
    {"build later", full, build_later, repeated},
    {"build later and grow", empty, build_later, first, Room::too_little},
    {"build later and read", empty, build_later_and_read, repeated},
    {"build later, drop and read", empty, build_later_and_read, repeated, Room::enough,
     Overflow::drop, 5},
    {"build later, drop and validate", empty, build_later_and_validate, repeated, Room::enough,
     Overflow::drop, 5},
    {"build later, drop and pack", empty, build_later_and_pack, repeated, Room::enough,
     Overflow::drop, 5},
    {"abandon a build", full, abandon_a_build, repeated},
    {"build in an automatic storage", empty, build_automatic, first, Room::enough, Overflow::grow,
     1, true},
    {"build two containers", empty, build_both, repeated},
    {"build two containers that grow", empty, build_both, first, Room::too_little},
    {"build two containers later", empty, build_both_later, repeated},
    {"build beside another container", empty, build_beside_another, repeated, Room::enough,
     Overflow::grow, 5},
    {"build by a kernel on another queue", empty, build_by_another_queue, repeated, Room::enough,
     Overflow::grow, 5},
    {"build slices", empty, build_slices, repeated, Room::for_a_part, Overflow::grow, 4},
    {"clear", full, clear},
    {"sort by a member", full, sort_by_a_member, first, Room::enough, Overflow::grow, 1, false,
     true},
    {"sort by an expression", full, sort_by_an_expression, repeated, Room::enough, Overflow::grow,
     1, false, true},
    {"sort without blocking", full, sort_without_blocking},
    {"sort a long list", full, sort_a_long_list, repeated, Room::enough, Overflow::grow, 1, false,
     true},
    {"lengths", full, lengths},
    {"pack", full, pack, repeated},
    {"pack a member", full, pack_a_member, repeated},
    {"download", full, download},
    {"validate", full, validate},
    {"read later", full, read_later, repeated},
    {"read in a kernel", full, read_in_a_kernel},
};

// ---- whole lives ---------------------------------------------------------------------------------

/// From the first object to the last.
void live_on(const Device& device, Storage storage) {
    const Inserts<Item> inserts = items();
    const Oracle<Item> oracle = oracle_of(inserts, cell_count);
    Kernel insert(device, source, "insert", type<Item>);
    const Buffer<cl_uint> cells(device, inserts.cells);
    const Buffer<Item> records(device, inserts.records);
    Lists<Item> lists(device, {cell_count},
                      options_of(device, storage, Room::too_little, Overflow::grow));
    require_all_stored(lists.build(insert, range(), cells, records, insert_count), oracle);
    require_lengths(lists.lengths(), oracle);
    require_packed(lists.pack(), oracle);
    lists.sort_by_async("record.id");
    require_sorted(lists.download(), oracle,
                   [](const Item& a, const Item& b) { return a.id < b.id; });
    require_sound(lists.validate());
    lists.clear();
    require(Contents::empty, lists, oracle);
}

void live_on_a_new_device(const Device&, Storage storage) { live_on(Device::choose(), storage); }

void make_a_device(const Device&, Storage) { Device::choose().finish(); }

void choose_by_name(const Device& device, Storage) {
    const std::string& name = device.info().name;
    const Device chosen = Device::choose(name);
    REQUIRE(chosen.info().name == name);
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
};

}  // namespace

Scene::Scene(const Device& on, Storage storage, const Operation& operation)
    : device(on),
      options(options_of(on, storage, operation.room, operation.overflow, operation.automatic)),
      inserts(items()),
      oracle(oracle_of(inserts, cell_count)),
      cells(on, inserts.cells),
      records(on, inserts.records),
      lists(on, {cell_count}, options),
      other(on, {cell_count}, options_of(on, next(storage), operation.room, operation.overflow)),
      insert(on, source, "insert", lists),
      insert_both(on, source, "insert_both", lists, other),
      read(on, source, "read", lists) {
    if (operation.automatic)
        while (tuner_of(lists)->storage() != storage)
            tuner_of(lists)->measured({{1e-3, 1e-3}, oracle.size(), 10});
    if (operation.before == Contents::full) build();
    if (operation.use == Use::repeated) operation.run(*this);
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
