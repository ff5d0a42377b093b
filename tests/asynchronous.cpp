// SPDX-License-Identifier: MIT
// The twins of the blocking calls: what they return is what the blocking calls return, and what
// uses a container before its build is finished waits for it.
#include "support/errors.hpp"
#include "support/inserts.hpp"
#include "support/storages.hpp"

namespace cellist::test {
namespace {

TEST_CASE("a build that is started is finished by get(), after growing too") {
    CELLIST_EACH_STORAGE(storage);
    CELLIST_RANDOM(random, 240u);
    const Inserts<Item> inserts = random_inserts(4096, 50, random);
    Lists<Item> lists(device(), {50}, {.storage = storage, .capacity_nodes = 10, .slots = 1});
    UploadedInserts scene(lists, inserts);
    for (int i = 0; i < 2; ++i) {
        Pending<BuildReport> pending = scene.build_async(lists);
        pending.event().wait();
        REQUIRE(pending.ready());
        const BuildReport report = pending.get();
        require_complete(report, 4096);
        REQUIRE(report.passes == (i == 0 ? 2 : passes_of(storage, 4096)));
        require_sound(lists, 4096);
        require_same(lists.download(), oracle_of(inserts, 50));
    }
}

TEST_CASE("what uses a container finishes its build") {
    CELLIST_EACH_STORAGE(storage);
    CELLIST_RANDOM(random, 241u);
    const Inserts<Item> inserts = random_inserts(4096, 50, random);
    Lists<Item> lists(device(), {50}, {.storage = storage, .capacity_nodes = 10, .slots = 1});
    UploadedInserts scene(lists, inserts);
    Pending<BuildReport> pending = scene.build_async(lists);
    SECTION("download") { require_same(lists.download(), oracle_of(inserts, 50)); }
    SECTION("sort") { lists.sort(&Item::key); }
    SECTION("lengths") { REQUIRE(lists.lengths().total == 4096); }
    SECTION("validate") { require_sound(lists, 4096); }
    SECTION("pack") { REQUIRE(lists.pack().records.size() == 4096); }
    SECTION("nobody") {}
    SECTION("another build") { require_complete(Inserter(lists).build(lists, inserts), 4096); }
    SECTION("a move") {
        Lists<Item> moved = std::move(lists);
        lists = std::move(moved);
    }
    require_complete(pending.get(), 4096);
    require_same(lists.download(), oracle_of(inserts, 50));
}

TEST_CASE("under drop nothing waits for the report, and the lists are there") {
    CELLIST_EACH_STORAGE(storage);
    CELLIST_RANDOM(random, 242u);
    Inserts<Item> inserts = random_inserts(4096, 50, random);
    inserts.add(51, {});
    Lists<Item> lists(
        device(), {50},
        {.storage = storage, .overflow = Overflow::drop, .capacity_nodes = 3000, .slots = 60});
    UploadedInserts scene(lists, inserts);
    Kernel count(device(), R"(
#include <cellist/lists.clh>
kernel void count(CELLIST_LISTS(Item, lists), global uint* lengths)
{
    uint length = 0;
    cellist_for_each(lists, get_global_id(0), node) ++length;
    lengths[get_global_id(0)] = length;
}
)",
                 "count", lists);
    const Buffer<cl_uint> lengths(device(), 50);
    Pending<BuildReport> pending = scene.build_async(lists);
    lists.sort(&Item::key);
    count.run(50, lists, lengths);
    Pending<std::vector<cl_uint>> counted = lengths.download_async();
    const BuildReport report = pending.get();
    REQUIRE(report.attempted == 4097);
    REQUIRE(report.rejected == 1);
    REQUIRE(report.stored + report.dropped == 4096);
    REQUIRE(report.passes == (storage == Storage::counted ? 2 : 1));
    if (!has_slots(storage)) REQUIRE(report.stored == 3000);
    require_sound(lists, report.stored);
    std::uint64_t total = 0;
    for (const cl_uint length : counted.get()) total += length;
    REQUIRE(total == report.stored);
}

TEST_CASE("an error of a pending build comes from the first use, and from get()") {
    CELLIST_EACH_STORAGE(storage);
    CELLIST_RANDOM(random, 243u);
    const Inserts<Item> inserts = random_inserts(4096, 50, random);
    Lists<Item> lists(
        device(), {50},
        {.storage = storage, .overflow = Overflow::stop, .capacity_nodes = 100, .slots = 3});
    UploadedInserts scene(lists, inserts);
    Pending<BuildReport> pending = scene.build_async(lists);
    REQUIRE_THROWS_AS(lists.sort(&Item::key), OverflowError);
    require_sound(lists, 0);
    const auto error = error_of<OverflowError>([&] { pending.get(); });
    REQUIRE(error.report().attempted == 4096);
    const Inserts<Item> few = random_inserts(50, 50, random);
    Inserts<Item> one_each = few;
    for (cl_uint i = 0; i < 50; ++i) one_each.cells[i] = i;
    require_complete(Inserter(lists).build(lists, one_each), 50);
}

TEST_CASE("lists may go before their build is finished") {
    CELLIST_EACH_STORAGE(storage);
    CELLIST_RANDOM(random, 244u);
    const Inserts<Item> inserts = random_inserts(4096, 50, random);
    Lists<Item> other(device(), {50}, {.storage = storage});
    UploadedInserts scene(other, inserts);
    for (const std::uint64_t capacity : {10u, 5000u}) {
        std::optional<Lists<Item>> lists(
            std::in_place, device(), Shape{50},
            ListsOptions{.storage = storage, .capacity_nodes = capacity});
        SECTION("the report is not asked for") {
            { const Pending<BuildReport> pending = scene.build_async(*lists); }
            lists.reset();
        }
        SECTION("the report is asked for afterwards") {
            Pending<BuildReport> pending = scene.build_async(*lists);
            lists.reset();
            require_complete(pending.get(), 4096);
        }
        SECTION("together with others") {
            const auto insert = [&] {
                scene.kernel.run(4096, *lists, scene.cells, scene.records, scene.count);
                scene.kernel.run(4096, other, scene.cells, scene.records, scene.count);
            };
            auto pending = build_async(insert, *lists, other);
            lists.reset();
            REQUIRE_THROWS_AS(pending.get(), Error);
            require_sound(other, 0);
        }
    }
    require_complete(Inserter(other).build(other, inserts), 4096);
}

TEST_CASE("results that are on their way outlive lists, buffers and the device") {
    CELLIST_EACH_STORAGE(storage);
    CELLIST_RANDOM(random, 248u);
    const Inserts<Item> inserts = random_inserts(4096, 50, random);
    std::optional<Device> own(Device::choose());
    std::optional<Lists<Item>> lists(std::in_place, *own, Shape{50},
                                     ListsOptions{.storage = storage});
    std::optional<Buffer<cl_uint>> buffer(std::in_place, *own, inserts.cells);
    Inserter(*lists, *own).build(*lists, inserts);
    Pending<HostLists<Item>> download = lists->download_async();
    Pending<Lengths> lengths = lists->lengths_async();
    Pending<Validation> validation = lists->validate_async();
    Pending<std::vector<cl_uint>> cells = buffer->download_async();
    lists.reset();
    buffer.reset();
    own.reset();
    require_same(download.get(), oracle_of(inserts, 50));
    REQUIRE(lengths.get().total == 4096);
    REQUIRE(validation.get().ok());
    REQUIRE(cells.get() == inserts.cells);
    // Once: there is nothing left for the second time.
    REQUIRE_THROWS_AS(download.get(), Error);
    REQUIRE_THROWS_AS(Pending<Lengths>().get(), Error);
}

TEST_CASE("results that are on their way are those of the blocking calls") {
    CELLIST_EACH_STORAGE(storage);
    CELLIST_RANDOM(random, 245u);
    const Inserts<Item> inserts = random_inserts(4096, 50, random);
    Lists<Item> lists(device(), {50}, {.storage = storage});
    Inserter(lists).build(lists, inserts);
    lists.sort(&Item::key);
    Pending<HostLists<Item>> download = lists.download_async();
    Pending<Lengths> lengths = lists.lengths_async();
    Pending<Validation> validation = lists.validate_async();
    Pending<HostLists<Item>> unused = lists.download_async();
    // What is enqueued later does not change them.
    lists.sort(&Item::id);
    REQUIRE(download.get().records().size() == 4096);
    REQUIRE(lengths.get().total == 4096);
    REQUIRE(validation.get().ok());
    Buffer<cl_uint> buffer(device(), 3);
    const std::vector<cl_uint> three{7, 8, 9};
    buffer.upload_async(three).wait();
    REQUIRE(buffer.download_async().get() == three);
    REQUIRE_THROWS_AS(buffer.upload_async(std::vector<cl_uint>(4)), Error);
}

TEST_CASE("several containers are built at once without blocking") {
    CELLIST_RANDOM(random, 246u);
    const Inserts<Item> inserts = random_inserts(4096, 50, random);
    for (const Storage first : all_storages)
        for (const Storage second : all_storages) {
            Lists<Item> a(device(), {50}, {.storage = first, .capacity_nodes = 10});
            Lists<Item> b(device(), {40}, {.storage = second, .capacity_nodes = 10});
            UploadedInserts scene(a, inserts);
            auto pending = build_async(
                [&] {
                    scene.kernel.run(4096, a, scene.cells, scene.records, scene.count);
                    scene.kernel.run(4096, b, scene.cells, scene.records, scene.count);
                },
                a, b);
            require_same(b.download(), oracle_of(inserts, 40));
            const auto [report_a, report_b] = pending.get();
            require_complete(report_a, 4096);
            require_same(a.download(), oracle_of(inserts, 50));
            REQUIRE(report_b.attempted == 4096);
        }
}

TEST_CASE("what is enqueued waits for the events of another queue") {
    CELLIST_RANDOM(random, 247u);
    const auto properties =
        GENERATE(cl_command_queue_properties{0},
                 cl_command_queue_properties{CL_QUEUE_OUT_OF_ORDER_EXEC_MODE_ENABLE});
    const auto cl_device = device().queue().getInfo<CL_QUEUE_DEVICE>();
    const cl::Context context(cl_device);
    std::optional<cl::CommandQueue> queue;
    try {
        queue.emplace(context, cl_device, properties);
    } catch (const cl::Error&) {
        return;  // the device has no such queue
    }
    const Device own(context, *queue);
    const cl::CommandQueue uploads(context, cl_device);
    CELLIST_EACH_STORAGE(storage);

    const Inserts<Item> inserts = random_inserts(4096, 50, random);
    Lists<Item> lists(own, {50}, {.storage = storage, .capacity_nodes = 10});
    UploadedInserts scene(lists, Inserts<Item>(inserts), own);
    scene.cells.fill(0xFFFFFFFFu);
    own.finish();
    // The cells are there only after the user event.
    cl::UserEvent go(context);
    const std::vector<cl::Event> before{go};
    cl::Event uploaded;
    uploads.enqueueWriteBuffer(scene.cells.cl(), CL_FALSE, 0, 4096 * sizeof(cl_uint),
                               inserts.cells.data(), &before, &uploaded);
    uploads.flush();
    own.enqueue_wait({uploaded});
    Pending<BuildReport> pending = scene.build_async(lists);
    const cl::Event all = own.enqueue_marker();
    REQUIRE_FALSE(pending.ready());
    go.setStatus(CL_COMPLETE);
    require_complete(pending.get(), 4096);
    all.wait();
    lists.sort(&Item::key);
    require_sound(lists, 4096);
    require_same(lists.download(), oracle_of(inserts, 50));
    own.enqueue_wait({});
}

}  // namespace
}  // namespace cellist::test
