// SPDX-License-Identifier: MIT
// Several devices on one context, each with a queue of its own: what a kernel of one does with
// lists and buffers of another is ordered with the other's queue.
#include <optional>

#include "support/errors.hpp"
#include "support/inserts.hpp"
#include "support/storages.hpp"

namespace cellist::test {
namespace {

constexpr auto queued_kernels_source = R"(
#include <cellist/lists.clh>

kernel void insert(CELLIST_LISTS(Item, lists))
{
    const uint i = get_global_id(0);
    Item item = { (float)(i % 100), i };
    cellist_insert(lists, i % cellist_cells(lists), item);
}

kernel void insert_both(CELLIST_LISTS(Item, first), CELLIST_LISTS(Item, second))
{
    const uint i = get_global_id(0);
    Item item = { (float)(i % 100), i };
    cellist_insert(first, i % cellist_cells(first), item);
    cellist_insert(second, i % cellist_cells(second), item);
}

kernel void sums(CELLIST_LISTS(Item, lists), global uint* sums)
{
    uint sum = 0;
    cellist_for_each(lists, get_global_id(0), node) sum += cellist_get(lists, node).id;
    sums[get_global_id(0)] = sum;
}

kernel void add(global uint* values, uint n) { values[get_global_id(0)] += n; }
)";

constexpr cl_uint queue_cells = 17;
constexpr cl_uint queue_records = 2000;

/// Two devices with a queue each, of which the second waits for an event.
struct TwoQueues {
    explicit TwoQueues(cl_command_queue_properties properties = 0)
        : cl_device(device().queue().getInfo<CL_QUEUE_DEVICE>()),
          context(cl_device),
          owner(context, cl::CommandQueue(context, cl_device, properties)),
          user(context, cl::CommandQueue(context, cl_device, properties)) {}
    /// What the user's queue does from now on waits for open().
    void close() {
        gate.emplace(context);
        user.enqueue_wait({*gate});
    }
    void open() { gate->setStatus(CL_COMPLETE); }

    cl::Device cl_device;
    cl::Context context;
    Device owner, user;
    /// NVIDIA's driver waits for ever at the end of a context with an event that nobody has set.
    std::optional<cl::UserEvent> gate;
};

bool is_complete(const cl::Event& event) {
    return event.getInfo<CL_EVENT_COMMAND_EXECUTION_STATUS>() == CL_COMPLETE;
}

void require_lists(const Lists<Item>& lists) {
    require_sound(lists, queue_records);
    const HostLists<Item> found = lists.download();
    for (cl_uint cell = 0; cell < queue_cells; ++cell)
        for (const Item& item : found.cell(cell)) REQUIRE(item.id % queue_cells == cell);
}

TEST_CASE("a build waits for the kernels of another queue") {
    CELLIST_EACH_STORAGE(storage);
    const auto properties =
        GENERATE(cl_command_queue_properties{0},
                 cl_command_queue_properties{CL_QUEUE_OUT_OF_ORDER_EXEC_MODE_ENABLE});
    std::optional<TwoQueues> scene;
    try {
        scene.emplace(properties);
    } catch (const cl::Error&) {
        return;  // the device has no such queue
    }
    Lists<Item> lists(scene->owner, {queue_cells}, {.storage = storage, .capacity_nodes = 3000});
    Lists<Item> others(scene->user, {queue_cells}, {.storage = storage, .capacity_nodes = 3000});
    Kernel insert(scene->user, queued_kernels_source, "insert", lists);
    for (int i = 0; i < 2; ++i) {
        scene->close();
        Pending<BuildReport> pending = lists.build_async(insert, queue_records);
        scene->owner.queue().flush();
        REQUIRE_FALSE(is_complete(pending.event()));
        scene->open();
        require_complete(pending.get(), queue_records);
        require_lists(lists);
    }
    require_complete(lists.build(insert, queue_records), queue_records);
    lists.sort(&Item::key);
    REQUIRE(lists.pack().records.download() == lists.download().records());

    // Lists of both queues at once.
    Kernel both(scene->owner, queued_kernels_source, "insert_both", lists, others);
    scene->close();
    auto pending =
        cellist::build_async([&] { both.run(queue_records, lists, others); }, lists, others);
    REQUIRE_FALSE(is_complete(pending.event()));
    scene->open();
    for (const BuildReport& report : pending.get()) require_complete(report, queue_records);
    require_lists(lists);
    require_lists(others);
}

TEST_CASE("one build of containers of two contexts is refused, and names both") {
    TwoQueues scene;
    const cl::Context other_context(scene.cl_device);
    const Device elsewhere(other_context, cl::CommandQueue(other_context, scene.cl_device));
    Lists<Item> here(scene.owner, {queue_cells});
    Lists<Item> there(elsewhere, {3});
    Kernel insert(scene.owner, queued_kernels_source, "insert", here);
    Kernel insert_there(elsewhere, queued_kernels_source, "insert", there);
    require_complete(here.build(insert, queue_records), queue_records);
    bool has_run = false;
    const auto refused = [&](auto&& build) {
        const auto error = error_of(build);
        INFO(error.what());
        REQUIRE(contains(error.what(), "lists of Item of shape 17 on " + elsewhere.info().name));
        REQUIRE(contains(error.what(), "lists of Item of shape 3 on " + elsewhere.info().name));
        REQUIRE(contains(error.what(), "contexts"));
        REQUIRE_FALSE(has_run);
    };
    const auto run = [&] { has_run = true; };
    refused([&] { cellist::build(run, here, there); });
    refused([&] { (void)cellist::build_async(run, there, here); });
    // The lists are as they were, and each is built alone.
    require_lists(here);
    require_complete(there.build(insert_there, queue_records), queue_records);
}

TEST_CASE("reading and writing wait for the kernels of another queue, and these for them") {
    TwoQueues scene;
    Lists<Item> lists(scene.owner, {queue_cells});
    Buffer<cl_uint> sums(scene.owner, queue_cells);
    sums.fill(7);
    Kernel insert(scene.owner, queued_kernels_source, "insert", lists);
    Kernel read(scene.user, queued_kernels_source, "sums", lists);
    Kernel add(scene.user, queued_kernels_source, "add", lists);

    // The kernel reads what was built before, though the queue of the lists goes on to clear them.
    lists.build(insert, queue_records);
    scene.close();
    const cl::Event done = read.run(queue_cells, lists, sums);
    lists.clear();
    const cl::Event cleared = scene.owner.enqueue_marker();
    scene.owner.queue().flush();
    REQUIRE_FALSE(is_complete(cleared));
    scene.open();
    std::vector<cl_uint> expected(queue_cells);
    for (cl_uint i = 0; i < queue_records; ++i) expected[i % queue_cells] += i;
    REQUIRE(sums.download() == expected);
    REQUIRE(is_complete(done));
    REQUIRE(lists.lengths().total == 0);

    // A buffer: filled, added to by the other queue, read, filled again.
    scene.close();
    sums.fill(1);
    add.run(queue_cells, sums, cl_uint{4});
    add.run(queue_cells, sums, cl_uint{5});
    Pending<std::vector<cl_uint>> first = sums.download_async();
    sums.fill(2);
    add.run(queue_cells, sums, cl_uint{1});
    scene.owner.queue().flush();
    REQUIRE_FALSE(first.ready());
    scene.open();
    REQUIRE(first.get() == std::vector<cl_uint>(queue_cells, 10));
    REQUIRE(sums.download() == std::vector<cl_uint>(queue_cells, 3));
}

}  // namespace
}  // namespace cellist::test
