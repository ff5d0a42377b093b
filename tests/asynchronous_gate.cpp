// SPDX-License-Identifier: MIT
// What does not block by its documentation returns while the device waits for an event that comes
// later.
#include <chrono>
#include <future>

#include "support/inserts.hpp"
#include "support/storages.hpp"

namespace cellist::test {
namespace {

/// Whether a call returns while the queue waits for an event. A call that waits for the queue ends
/// afterwards.
bool returns_before_the_device(const std::function<void()>& call) {
    using namespace std::chrono_literals;
    cl::UserEvent gate(device().context());
    device().enqueue_wait({gate});
    std::future<void> done = std::async(std::launch::async, call);
    const bool returned = done.wait_for(60s) == std::future_status::ready;
    gate.setStatus(CL_COMPLETE);
    done.get();
    device().finish();
    return returned;
}

struct GatedBuild {
    explicit GatedBuild(const ListsOptions& options) : lists(device(), {50}, options) {
        std::mt19937 random(280);
        inserts = random_inserts(4096, 50, random);
        cells.emplace(device(), inserts.cells);
        records.emplace(device(), inserts.records);
        kernel.emplace(device(), insert_source("Item"), "insert_all", lists);
    }
    [[nodiscard]] Pending<BuildReport> build_async() {
        return lists.build_async(*kernel, Range::padded(4096, 64), *cells, *records, cl_uint{4096});
    }

    Lists<Item> lists;
    Inserts<Item> inserts;
    std::optional<Buffer<cl_uint>> cells;
    std::optional<Buffer<Item>> records;
    std::optional<Kernel> kernel;
};

/// Every call that follows a build and does not block, and what they return.
struct Calls {
    explicit Calls(Lists<Item>& lists) {
        lists.sort_async(&Item::key);
        lists.sort_by_async("record.id ^ 1u");
        packed = lists.pack();
        ids = lists.pack(&Item::id);
        download = lists.download_async();
        lengths = lists.lengths_async();
        validation = lists.validate_async();
        buffer.fill(7);
        buffer.upload_async(three);
        words = buffer.download_async();
        marker = device().enqueue_marker();
    }

    /// Requires the results to be those of lists that hold what the oracle says.
    void require_results(const Oracle<Item>& oracle) {
        require_same(download->get(), oracle);
        REQUIRE(lengths->get().total == oracle.size());
        const Validation found = validation->get();
        INFO(found.message());
        REQUIRE(found.ok());
        REQUIRE(words->get() == std::vector<cl_uint>{1, 2, 3, 7});
        const std::vector<cl_uint> offsets = packed->offsets.download();
        REQUIRE(offsets.back() == oracle.size());
        REQUIRE(ids->offsets.download() == offsets);
        const std::vector<Item> records = packed->records.download();
        const std::vector<cl_uint> id = ids->records.download();
        REQUIRE(records.size() >= oracle.size());
        for (std::size_t i = 0; i < oracle.size(); ++i) REQUIRE(records[i].id == id[i]);
    }

    std::vector<cl_uint> three{1, 2, 3};
    Buffer<cl_uint> buffer{device(), 4};
    std::optional<Packed<Item>> packed;
    std::optional<Packed<cl_uint>> ids;
    std::optional<Pending<HostLists<Item>>> download;
    std::optional<Pending<Lengths>> lengths;
    std::optional<Pending<Validation>> validation;
    std::optional<Pending<std::vector<cl_uint>>> words;
    cl::Event marker;
};

TEST_CASE("under drop a build and all that reads it are enqueued at once") {
    CELLIST_EACH_STORAGE(storage);
    GatedBuild scene(
        {.storage = storage, .overflow = Overflow::drop, .capacity_nodes = 5000, .slots = 200});
    (void)scene.build_async().get();
    { const Calls compiled(scene.lists); }
    std::optional<Pending<BuildReport>> pending;
    std::optional<Calls> calls;
    REQUIRE(returns_before_the_device([&] {
        pending = scene.build_async();
        calls.emplace(scene.lists);
    }));
    calls->require_results(oracle_of(scene.inserts, 50));
    // The number of records was not known.
    REQUIRE(calls->packed->records.size() == scene.lists.capacity_nodes());
    require_complete(pending->get(), 4096);
    REQUIRE(scene.lists.pack().records.size() == 4096);
}

TEST_CASE("what reads finished lists is enqueued at once") {
    CELLIST_EACH_STORAGE(storage);
    GatedBuild scene({.storage = storage});
    (void)scene.build_async().get();
    { const Calls compiled(scene.lists); }
    std::optional<Calls> calls;
    REQUIRE(returns_before_the_device([&] { calls.emplace(scene.lists); }));
    calls->require_results(oracle_of(scene.inserts, 50));
    REQUIRE(calls->packed->records.size() == 4096);
    std::optional<Pending<BuildReport>> pending;
    REQUIRE(returns_before_the_device([&] {
        scene.lists.clear();
        pending = scene.build_async();
    }));
    require_complete(pending->get(), 4096);
}

TEST_CASE("a validation that is asked for before a build ends is that of this build") {
    CELLIST_EACH_STORAGE(storage);
    GatedBuild scene(
        {.storage = storage, .overflow = Overflow::drop, .capacity_nodes = 3000, .slots = 60});
    Pending<BuildReport> first = scene.build_async();
    Pending<Validation> validation = scene.lists.validate_async();
    scene.lists.clear();
    REQUIRE(validation.get().ok());
    REQUIRE(first.get().dropped > 0);
}

}  // namespace
}  // namespace cellist::test
