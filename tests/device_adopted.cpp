// SPDX-License-Identifier: MIT
// The library works on the user's own context and queue.
#include <chrono>
#include <thread>

#include "support/errors.hpp"
#include "support/inserts.hpp"
#include "support/storages.hpp"

namespace cellist::test {
namespace {

cl::Device cl_device() { return device().queue().getInfo<CL_QUEUE_DEVICE>(); }

TEST_CASE("work of the library and of the user is ordered on the user's queue") {
    CELLIST_RANDOM(random, 150u);
    const cl::Context context(cl_device());
    const cl::CommandQueue queue(context, cl_device());
    const Device own(context, queue);
    REQUIRE(own.context()() == context());
    REQUIRE(own.queue()() == queue());
    REQUIRE(own.info().name == device().info().name);

    constexpr cl_uint count = 4096;
    const Inserts<Item> inserts = random_inserts(count, 50, random);
    const cl::Buffer cells(context, CL_MEM_READ_ONLY, count * sizeof(cl_uint));
    const cl::Buffer records(context, CL_MEM_READ_ONLY, count * sizeof(Item));
    queue.enqueueWriteBuffer(cells, CL_FALSE, 0, count * sizeof(cl_uint), inserts.cells.data());
    queue.enqueueWriteBuffer(records, CL_FALSE, 0, count * sizeof(Item), inserts.records.data());

    Lists<Item> lists(own, {50}, {.capacity_nodes = 10});
    Kernel insert(own, insert_source("Item"), "insert_all", lists);
    require_complete(lists.build(insert, count, cells, records, count), count);
    require_same(lists.download(), oracle_of(inserts, 50));

    Kernel add(own, R"(
kernel void add(global uint* values, uint amount) { values[get_global_id(0)] += amount; }
)",
               "add");
    const cl::Buffer values(context, CL_MEM_READ_WRITE, 100 * sizeof(cl_uint));
    queue.enqueueFillBuffer(values, cl_uint{7}, 0, 100 * sizeof(cl_uint));
    add.run(100, values, cl_uint{5});
    std::vector<cl_uint> host(100);
    queue.enqueueReadBuffer(values, CL_FALSE, 0, 100 * sizeof(cl_uint), host.data());
    own.finish();
    REQUIRE(host == std::vector<cl_uint>(100, 12));
}

TEST_CASE("a queue of another context is refused") {
    const cl::Context context(cl_device());
    const cl::Context other(cl_device());
    const cl::CommandQueue queue(other, cl_device());
    const auto error = error_of([&] { Device(context, queue); });
    INFO(error.what());
    REQUIRE(contains(error.what(), "context"));
}

TEST_CASE("commands run in order on a queue that is out of order") {
    const cl::Context context(cl_device());
    std::optional<cl::CommandQueue> queue;
    try {
        queue.emplace(context, cl_device(),
                      cl::QueueProperties(CL_QUEUE_OUT_OF_ORDER_EXEC_MODE_ENABLE));
    } catch (const cl::Error&) {
        return;  // the device has none
    }
    const Device own(context, *queue);
    CELLIST_EACH_STORAGE(storage);
    CELLIST_RANDOM(random, 152u);
    Lists<Item> lists(own, {50}, {.storage = storage, .capacity_nodes = 10});
    Inserter inserter(lists, own);
    for (int i = 0; i < 20; ++i) {
        const Inserts<Item> inserts = random_inserts(2000, 50, random);
        require_complete(inserter.build(lists, inserts), 2000);
        lists.sort(&Item::key);
        require_sound(lists, 2000);
        require_same(lists.download(), oracle_of(inserts, 50));
        REQUIRE(lists.pack().records.download() == lists.download().records());
    }
}

TEST_CASE("the library lets go of the user's context and queue, after errors too") {
    const cl::Context context(cl_device());
    const cl::CommandQueue queue(context, cl_device());
    const auto context_count = context.getInfo<CL_CONTEXT_REFERENCE_COUNT>();
    const auto queue_count = queue.getInfo<CL_QUEUE_REFERENCE_COUNT>();
    {
        CELLIST_RANDOM(random, 151u);
        const Device own(context, queue);
        Lists<Item> lists(own, {50}, {.overflow = Overflow::stop, .capacity_nodes = 100});
        Inserter inserter(lists, own);
        inserter.build(lists, random_inserts(100, 50, random));
        lists.sort(&Item::key);
        REQUIRE(lists.validate().ok());
        REQUIRE(lists.download().records().size() == 100);
        REQUIRE_THROWS_AS(inserter.build(lists, random_inserts(101, 50, random)), OverflowError);
        REQUIRE_THROWS_AS(lists.sort_by("nonsense"), OpenClError);
        REQUIRE_THROWS_AS(Kernel(own, "nonsense", "nonsense"), OpenClError);
        REQUIRE_THROWS_AS(Lists<Item>(own, {50}, {.capacity_nodes = ~std::uint64_t{0}}), Error);
    }
    queue.finish();
    // PoCL lets go of finished commands on another thread.
    for (int i = 0; i < 200 && queue.getInfo<CL_QUEUE_REFERENCE_COUNT>() != queue_count; ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    REQUIRE(context.getInfo<CL_CONTEXT_REFERENCE_COUNT>() == context_count);
    REQUIRE(queue.getInfo<CL_QUEUE_REFERENCE_COUNT>() == queue_count);
}

}  // namespace
}  // namespace cellist::test
