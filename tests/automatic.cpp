// SPDX-License-Identifier: MIT
// Storage::automatic does what the other storages do, while it tries them, when one is chosen, and
// when the one that was chosen fails. Which is chosen depends on the device: tests that need a
// certain one tell the tuner of times of their own.
#include "support/errors.hpp"
#include "support/inserts.hpp"
#include "support/internals.hpp"
#include "support/storages.hpp"

namespace cellist::test {
namespace {

using detail::StorageTuner;

/// As if the trial had come out in favour of a storage, for lists like these.
void choose(const Lists<Item>& lists, Storage storage, std::uint64_t stored,
            std::uint64_t longest) {
    StorageTuner& tuner = *tuner_of(lists);
    while (tuner.on_trial())
        tuner.measured({{tuner.storage() == storage ? 1e-3 : 1.0, 1e-3}, stored, longest});
    INFO(tuner.reason());
    REQUIRE(tuner.storage() == storage);
}

std::uint64_t longest_of(const Inserts<Item>& inserts, cl_uint cells) {
    std::vector<std::uint64_t> lengths(cells);
    for (const cl_uint cell : inserts.cells)
        if (cell < cells) ++lengths[cell];
    return *std::max_element(lengths.begin(), lengths.end());
}

/// Every record, in every way to read them.
void require_lists(Lists<Item>& lists, const Inserts<Item>& inserts) {
    const Oracle<Item> oracle = oracle_of(inserts, lists.shape().cells());
    require_sound(lists, oracle.size());
    require_same(lists.download(), oracle);
    lists.sort(&Item::key);
    require_sound(lists, oracle.size());
    const HostLists<Item> sorted = lists.download();
    require_same(sorted, oracle);
    for (std::uint64_t cell = 0; cell < sorted.cells(); ++cell)
        REQUIRE(std::is_sorted(sorted.cell(cell).begin(), sorted.cell(cell).end(),
                               [](const Item& a, const Item& b) {
                                   return std::pair(a.key, a.id) < std::pair(b.key, b.id);
                               }));
    const std::vector<Item> packed = lists.pack().records.download();
    REQUIRE(packed == std::vector<Item>(sorted.records().begin(), sorted.records().end()));
}

const ListsOptions automatic{.storage = Storage::automatic};

TEST_CASE("lists are complete in every build of a trial and after it") {
    CELLIST_RANDOM(random, 270u);
    Lists<Item> lists(device(), {10, 5}, automatic);
    REQUIRE(lists.storage() == Storage::linked);
    Inserter inserter(lists);
    std::vector<Storage> used;
    int builds = 0;
    for (; tuner_of(lists)->on_trial() || builds < 15; ++builds) {
        REQUIRE(builds < 20);
        Inserts<Item> inserts = random_inserts(4000u + 10u * below(random, 10), 50, random);
        inserts.add(50, {});
        const BuildReport report = inserter.build(lists, inserts);
        INFO("build " << builds << ": " << lists.storage_reason());
        require_complete(report, inserts.size() - 1, 1);
        require_lists(lists, inserts);
        REQUIRE(lists.storage() != Storage::automatic);
        used.push_back(lists.storage());
    }
    for (const Storage storage : detail::choices)
        REQUIRE(std::find(used.begin(), used.end(), storage) != used.end());
    REQUIRE(contains(lists.storage_reason(), "= "));
    REQUIRE(contains(lists.storage_reason(), name_of(lists.storage())));
    REQUIRE(used.back() == tuner_of(lists)->storage());
}

TEST_CASE("the other storages say that they were asked for") {
    const Storage storage = GENERATE(from_range(detail::choices));
    INFO(name_of(storage));
    const Lists<Item> lists(device(), {10}, {.storage = storage});
    REQUIRE(lists.storage() == storage);
    REQUIRE(tuner_of(lists) == nullptr);
    REQUIRE(contains(lists.storage_reason(), std::string(name_of(storage)) + ":"));
}

TEST_CASE("no build after the first needs more passes than its storage") {
    CELLIST_RANDOM(random, 271u);
    const Inserts<Item> inserts = random_inserts(100'000, 5000, random);
    Lists<Item> lists(device(), {5000}, automatic);
    UploadedInserts scene(lists, inserts);
    const auto insert = [&] { scene.insert(lists); };
    REQUIRE(lists.build(insert).passes == 2);
    for (int i = 0; i < 14; ++i) {
        const BuildReport report = lists.build(insert);
        require_complete(report, 100'000);
        INFO(name_of(lists.storage()));
        REQUIRE(report.passes == passes_of(lists.storage(), 100'000));
    }
}

TEST_CASE("records that grow in number from build to build are all stored") {
    CELLIST_RANDOM(random, 272u);
    Lists<Item> lists(device(), {50}, automatic);
    Inserter inserter(lists);
    for (const std::uint32_t size :
         {0u,      1u,      7u,     93u,    144u, 0u, 4096u, 5000u, 9000u, 20000u, 70000u,
          100000u, 100000u, 70000u, 20000u, 0u,   1u, 93u,   144u,  4096u, 50000u}) {
        const Inserts<Item> inserts = random_inserts(size, 50, random);
        INFO(size << " records: " << lists.storage_reason());
        require_complete(inserter.build(lists, inserts), size);
        require_same(lists.download(), oracle_of(inserts, 50));
    }
}

TEST_CASE("every storage serves when it is chosen, and clear() empties it") {
    const Storage storage = GENERATE(from_range(detail::choices));
    INFO(name_of(storage));
    CELLIST_RANDOM(random, 273u);
    const Inserts<Item> inserts = random_inserts(4096, 50, random);
    Lists<Item> lists(device(), {50}, automatic);
    choose(lists, storage, 4096, longest_of(inserts, 50));
    UploadedInserts scene(lists, inserts);
    const BuildReport report = lists.build([&] { scene.insert(lists); });
    require_complete(report, 4096);
    REQUIRE(report.passes == passes_of(storage, 4096));
    REQUIRE(lists.storage() == storage);
    require_lists(lists, inserts);
    lists.clear();
    require_sound(lists, 0);
    Lists<Item> moved = std::move(lists);
    require_complete(moved.build([&] { scene.insert(moved); }), 4096);
    require_lists(moved, inserts);
}

TEST_CASE("a list that became too long for slots goes to another storage") {
    CELLIST_RANDOM(random, 274u);
    const Inserts<Item> even = random_inserts(100'000, 2000, random);
    Inserts<Item> uneven = even;
    for (cl_uint i = 0; i < 5000; ++i) uneven.add(7, {1.0f, 100'000 + i});
    const bool asynchronous = GENERATE(false, true);
    Lists<Item> lists(device(), {2000}, automatic);
    choose(lists, Storage::fixed, even.size(), longest_of(even, 2000));
    UploadedInserts even_scene(lists, even), uneven_scene(lists, uneven);
    const auto build = [&](UploadedInserts& scene) {
        const auto insert = [&] { scene.insert(lists); };
        return asynchronous ? lists.build_async(insert).get() : lists.build(insert);
    };
    require_complete(build(even_scene), even.size());
    REQUIRE(lists.storage() == Storage::fixed);

    const BuildReport report = build(uneven_scene);
    require_complete(report, uneven.size());
    REQUIRE(report.passes == 2);
    REQUIRE(lists.storage() == Storage::linked);
    REQUIRE(contains(lists.storage_reason(), "fixed left"));
    require_lists(lists, uneven);
    REQUIRE(lists.capacity_nodes() == uneven.size());
    require_complete(build(even_scene), even.size());
    require_lists(lists, even);
}

TEST_CASE("slots grow within four for each record") {
    CELLIST_RANDOM(random, 275u);
    const Inserts<Item> inserts = random_inserts(100'000, 2000, random);
    Lists<Item> lists(device(), {2000}, automatic);
    choose(lists, Storage::fixed, inserts.size(), 10);
    const BuildReport report = Inserter(lists).build(lists, inserts);
    require_complete(report, inserts.size());
    REQUIRE(report.passes == 2);
    REQUIRE(lists.storage() == Storage::fixed);
    require_lists(lists, inserts);
}

constexpr auto unrepeatable_source = R"(
#include <cellist/lists.clh>
// In the n-th run work-item i inserts into cell (i + n) % (n + 1).
kernel void vary(CELLIST_LISTS(Item, lists), volatile global uint* runs)
{
    const uint i = get_global_id(0), run = atomic_inc(runs) / get_global_size(0);
    Item item = { (float)run, i };
    cellist_insert(lists, (i + run) % (run + 1), item);
}
)";

TEST_CASE("a kernel that does not repeat itself is never counted twice, and nobody notices") {
    constexpr cl_uint records = 300;
    Lists<Item> lists(device(), {200}, automatic);
    Kernel vary(device(), unrepeatable_source, "vary", lists);
    Buffer<cl_uint> runs(device(), 1);
    runs.fill(0);
    const int way = GENERATE(0, 1, 2);
    if (way > 0) choose(lists, Storage::counted, records, records);
    Lists<Item> other(device(), {10}, {.storage = Storage::counted});
    Kernel plain(device(), insert_source("Item"), "insert_all", other);
    Inserts<Item> few;
    for (cl_uint i = 0; i < 20; ++i) few.add(i % 10, {0.0f, i});
    const Buffer<cl_uint> few_cells(device(), few.cells);
    const Buffer<Item> few_records(device(), few.records);
    const auto build = [&] {
        if (way == 0) return lists.build(vary, records, runs);
        if (way == 1) return lists.build_async(vary, records, runs).get();
        const auto reports = cellist::build(
            [&] {
                vary.run(records, lists, runs);
                plain.run(20, other, few_cells, few_records, cl_uint{20});
            },
            lists, other);
        require_complete(reports[1], 20);
        require_same(other.download(), oracle_of(few, 10));
        return reports[0];
    };
    for (int i = 0; i < 16; ++i) {
        INFO("build " << i << ": " << lists.storage_reason());
        const BuildReport report = build();
        require_complete(report, records);
        require_sound(lists, records);
        // The records are those of the last run.
        const cl_uint run = runs.download()[0] / records - 1;
        Inserts<Item> last;
        for (cl_uint item = 0; item < records; ++item)
            last.add((item + run) % (run + 1), {static_cast<cl_float>(run), item});
        require_same(lists.download(), oracle_of(last, 200));
        if (way > 0 || i > 5) REQUIRE(lists.storage() != Storage::counted);
    }
    REQUIRE(contains(lists.storage_reason(), "counted left: the kernel does not repeat itself"));
}

TEST_CASE("stop throws when the records are more than the capacity, in a trial and after it") {
    CELLIST_RANDOM(random, 276u);
    const Inserts<Item> fits = random_inserts(1000, 50, random);
    const Inserts<Item> too_many = random_inserts(1001, 50, random);
    const auto slots = GENERATE(std::optional<std::uint32_t>(), std::optional<std::uint32_t>(20));
    Lists<Item> lists(device(), {50},
                      {.storage = Storage::automatic,
                       .overflow = Overflow::stop,
                       .capacity_nodes = 1000,
                       .slots = slots});
    Inserter inserter(lists);
    for (int i = 0; i < 15; ++i) {
        INFO("build " << i << ": " << lists.storage_reason());
        const auto error = error_of<OverflowError>([&] { inserter.build(lists, too_many); });
        REQUIRE(error.report().attempted == 1001);
        require_sound(lists, 0);
        REQUIRE(lists.download().records().empty());
        require_complete(inserter.build(lists, fits), 1000);
        require_same(lists.download(), oracle_of(fits, 50));
        REQUIRE(lists.capacity_nodes() <= 1000);
    }
    REQUIRE_FALSE(tuner_of(lists)->on_trial());
}

TEST_CASE("drop keeps as many records as the capacity, whatever the storage") {
    CELLIST_RANDOM(random, 277u);
    const auto slots = GENERATE(std::optional<std::uint32_t>(), std::optional<std::uint32_t>(20));
    Lists<Item> lists(device(), {50},
                      {.storage = Storage::automatic,
                       .overflow = Overflow::drop,
                       .capacity_nodes = 1000,
                       .slots = slots});
    Inserter inserter(lists);
    for (const bool chosen : {false, true}) {
        if (chosen && slots) choose(lists, Storage::fixed, 600, 20);
        for (int i = 0; i < 15; ++i) {
            const std::uint32_t size = 400 + 200 * below(random, 6);
            const Inserts<Item> inserts = random_inserts(size, 50, random);
            INFO("build " << i << ": " << lists.storage_reason());
            const BuildReport report = inserter.build(lists, inserts);
            REQUIRE(report.attempted == size);
            REQUIRE(report.stored == std::min(size, 1000u));
            REQUIRE(report.dropped == size - report.stored);
            require_sound(lists, report.stored);
            REQUIRE(lists.download().records().size() == report.stored);
        }
        if (!chosen) break;
    }
}

TEST_CASE("slots that would drop what the others keep are left") {
    CELLIST_RANDOM(random, 278u);
    const Overflow overflow = GENERATE(Overflow::stop, Overflow::drop);
    Inserts<Item> inserts = random_inserts(500, 50, random);
    for (cl_uint i = 0; i < 30; ++i) inserts.add(3, {0.0f, 500 + i});
    Lists<Item> lists(
        device(), {50},
        {.storage = Storage::automatic, .overflow = overflow, .capacity_nodes = 1000, .slots = 20});
    choose(lists, Storage::fixed, 500, 20);
    UploadedInserts scene(lists, inserts);
    SECTION("blocking") {
        const BuildReport report = lists.build([&] { scene.insert(lists); });
        require_complete(report, 530);
        REQUIRE(report.passes == 2);
    }
    SECTION("asynchronous, and used before it is finished") {
        auto pending = lists.build_async([&] { scene.insert(lists); });
        lists.sort(&Item::key);
        require_complete(pending.get(), 530);
    }
    REQUIRE(lists.storage() == Storage::linked);
    require_lists(lists, inserts);
}

TEST_CASE("stop and drop need capacity_nodes") {
    for (const Overflow overflow : {Overflow::stop, Overflow::drop})
        REQUIRE(contains(error_of([&] {
                             Lists<Item>(
                                 device(), {10},
                                 {.storage = Storage::automatic, .overflow = overflow, .slots = 3});
                         }).what(),
                         "capacity_nodes"));
}

TEST_CASE("the budget holds in every build, and what does not fit it is not chosen") {
    CELLIST_RANDOM(random, 279u);
    const Inserts<Item> inserts = random_inserts(50'000, 1000, random);
    const Inserts<Item> few = random_inserts(5000, 1000, random);
    // Linked lists take 600,000 bytes for their nodes, counted lists 400,000.
    for (const std::uint64_t budget : {700'000u, 500'000u}) {
        INFO("budget of " << budget);
        Lists<Item> lists(
            device(), {1000},
            {.storage = Storage::automatic, .capacity_nodes = 10, .budget_bytes = budget});
        Inserter inserter(lists);
        for (int i = 0; i < 15; ++i) {
            INFO("build " << i << ": " << lists.storage_reason());
            require_complete(inserter.build(lists, inserts), inserts.size());
            REQUIRE(lists.pool_bytes() <= budget);
            if (budget == 500'000u) REQUIRE(lists.storage() == Storage::counted);
            if (i % 5 == 0) require_lists(lists, inserts);
        }
    }
    // Nothing fits.
    Lists<Item> lists(
        device(), {1000},
        {.storage = Storage::automatic, .capacity_nodes = 10, .budget_bytes = 300'000});
    Inserter inserter(lists);
    for (int i = 0; i < 3; ++i) {
        const auto error = error_of<OverflowError>([&] { inserter.build(lists, inserts); });
        REQUIRE(error.report().attempted == inserts.size());
        require_sound(lists, 0);
        for (int j = 0; j < 4; ++j) require_complete(inserter.build(lists, few), few.size());
        require_lists(lists, few);
    }
}

TEST_CASE("sizes that no storage can have are refused") {
    for (const ListsOptions& options :
         {ListsOptions{.storage = Storage::automatic, .budget_bytes = 100},
          ListsOptions{.storage = Storage::automatic, .capacity_nodes = std::uint64_t{1} << 60}}) {
        const auto of = [&](Storage storage) {
            ListsOptions same = options;
            same.storage = storage;
            return std::string(error_of([&] { Lists<Item>(device(), {100}, same); }).what());
        };
        REQUIRE(of(Storage::automatic) == of(Storage::linked));
    }
}

TEST_CASE(
    "asynchronous builds, several containers and slices take what is chosen and try nothing") {
    const Storage storage = GENERATE(from_range(detail::choices));
    INFO(name_of(storage));
    CELLIST_RANDOM(random, 280u);
    const Inserts<Item> inserts = random_inserts(4096, 50, random);
    Lists<Item> lists(device(), {50}, automatic), other(device(), {50}, automatic);
    UploadedInserts scene(lists, inserts);
    const auto insert = [&] { scene.insert(lists); };
    const bool chosen = GENERATE(false, true);
    if (chosen) choose(lists, storage, 4096, longest_of(inserts, 50));
    const Storage expected = chosen ? storage : Storage::linked;
    for (int i = 0; i < 3; ++i) {
        require_complete(lists.build_async(insert).get(), 4096);
        REQUIRE(lists.storage() == expected);
        require_lists(lists, inserts);

        const auto reports = cellist::build(
            [&] {
                scene.insert(lists);
                scene.insert(other);
            },
            lists, other);
        require_complete(reports[0], 4096);
        require_complete(reports[1], 4096);
        REQUIRE(lists.storage() == expected);
        REQUIRE(other.storage() == Storage::linked);
        require_lists(lists, inserts);
        require_lists(other, inserts);

        Oracle<Item> all;
        const BuildReport report = lists.build_slices(insert, [&](const Slice& slice) {
            const HostLists<Item> found = lists.download();
            for (std::uint64_t cell = 0; cell < found.cells(); ++cell)
                for (const Item& item : found.cell(cell)) {
                    REQUIRE(cell - slice.first_cell < slice.cells);
                    all.emplace(cell, item);
                }
        });
        REQUIRE(report.stored == 4096);
        REQUIRE(all.size() == 4096);
        require_sound(lists, 0);
    }
    REQUIRE(tuner_of(lists)->on_trial() == !chosen);
}

TEST_CASE("slices fit the budget") {
    const Storage storage = GENERATE(from_range(detail::choices));
    INFO(name_of(storage));
    CELLIST_RANDOM(random, 281u);
    const Inserts<Item> inserts = random_inserts(4096, 50, random);
    Lists<Item> lists(
        device(), {50},
        {.storage = Storage::automatic, .capacity_nodes = 100, .budget_bytes = 10'000});
    choose(lists, storage, 400, 8);
    UploadedInserts scene(lists, inserts);
    std::uint64_t stored = 0;
    int slices = 0;
    lists.build_slices([&] { scene.insert(lists); },
                       [&](const Slice&) {
                           ++slices;
                           stored += lists.lengths().total;
                           REQUIRE(lists.pool_bytes() <= 10'000);
                       });
    REQUIRE(slices > 3);
    REQUIRE(stored == 4096);
    const Inserts<Item> few = random_inserts(300, 50, random);
    require_complete(Inserter(lists).build(lists, few), 300);
    require_lists(lists, few);
}

TEST_CASE("an exception in any build of a trial leaves an empty container, and the trial goes on") {
    CELLIST_RANDOM(random, 282u);
    const Inserts<Item> inserts = random_inserts(4096, 50, random);
    Lists<Item> lists(device(), {50}, automatic);
    UploadedInserts scene(lists, inserts);
    for (int i = 0; i < 15; ++i) {
        INFO("build " << i << ": " << lists.storage_reason());
        const auto error = error_of<std::runtime_error>([&] {
            lists.build([&] {
                scene.insert(lists);
                throw std::runtime_error("enough");
            });
        });
        REQUIRE(std::string(error.what()) == "enough");
        require_sound(lists, 0);
        require_complete(lists.build([&] { scene.insert(lists); }), 4096);
        require_lists(lists, inserts);
    }
    REQUIRE_FALSE(tuner_of(lists)->on_trial());
}

TEST_CASE("a shape without cells, and records of odd sizes") {
    Lists<Item> none(device(), {0}, automatic);
    CELLIST_RANDOM(random, 283u);
    const Inserts<Item> inserts = random_inserts(144, 50, random);
    Inserter inserter(none);
    for (int i = 0; i < 5; ++i) require_complete(inserter.build(none, inserts), 0, 144);
    REQUIRE(none.storage() == Storage::linked);
}

/// No word long, and not a multiple of one.
struct Odd {
    cl_uchar bytes[5];
};
CELLIST_STRUCT(Odd, bytes);

TEST_CASE("records need not be made of words") {
    Inserts<Odd> inserts;
    for (cl_uint i = 0; i < 1000; ++i)
        inserts.add(i % 30, {{static_cast<cl_uchar>(i), 1, 2, 3, static_cast<cl_uchar>(i >> 8)}});
    Lists<Odd> lists(device(), {30}, automatic);
    Inserter inserter(lists);
    for (int i = 0; i < 15; ++i) {
        require_complete(inserter.build(lists, inserts), 1000);
        require_same(lists.download(), oracle_of(inserts, 30));
    }
}

}  // namespace
}  // namespace cellist::test
