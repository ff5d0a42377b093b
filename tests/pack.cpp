// pack() returns in device memory what download() returns in host memory.
#include "support/inserts.hpp"
#include "support/storages.hpp"

namespace cellist::test {
namespace {

void require_packed(const Lists<Item>& lists, const Oracle<Item>& oracle) {
    const Packed<Item> packed = lists.pack();
    REQUIRE(packed.offsets.size() == lists.shape().cells() + 1);
    REQUIRE(packed.records.size() == oracle.size());
    const std::vector<cl_uint> offsets = packed.offsets.download();
    const std::vector<Item> records = packed.records.download();
    const HostLists<Item> host = lists.download();
    REQUIRE(
        std::equal(offsets.begin(), offsets.end(), host.offsets().begin(), host.offsets().end()));
    REQUIRE(records == host.records());

    REQUIRE(offsets.front() == 0);
    REQUIRE(offsets.back() == oracle.size());
    for (std::uint64_t cell = 0; cell < lists.shape().cells(); ++cell)
        REQUIRE(offsets[cell + 1] - offsets[cell] == oracle.count(cell));
    require_same(host, oracle);
}

TEST_CASE("packed lists are those of the download, sorted or not") {
    CELLIST_EACH_STORAGE(storage);
    CELLIST_RANDOM(random, 210u);
    Lists<Item> lists(device(), {16, 9}, {.storage = storage});
    Inserter inserter(lists);
    for (const std::size_t count : {0u, 1u, 7u, 93u, 144u, 4096u}) {
        INFO(count << " records");
        const Inserts<Item> inserts = random_inserts(count, 150, random);
        inserter.build(lists, inserts);
        require_packed(lists, oracle_of(inserts, 144));
        lists.sort(&Item::key);
        require_packed(lists, oracle_of(inserts, 144));
    }
}

TEST_CASE("a member is packed alone") {
    CELLIST_EACH_STORAGE(storage);
    CELLIST_RANDOM(random, 213u);
    Lists<Item> lists(device(), {16, 9}, {.storage = storage});
    Inserter(lists).build(lists, random_inserts(4096, 144, random));
    lists.sort(&Item::id);
    const HostLists<Item> host = lists.download();
    const Packed<cl_float> keys = lists.pack(&Item::key);
    const Packed<cl_uint> ids = lists.pack(&Item::id);
    const std::vector<cl_uint> offsets = keys.offsets.download();
    REQUIRE(
        std::equal(offsets.begin(), offsets.end(), host.offsets().begin(), host.offsets().end()));
    REQUIRE(ids.offsets.download() == offsets);
    const std::vector<cl_float> found_keys = keys.records.download();
    const std::vector<cl_uint> found_ids = ids.records.download();
    REQUIRE(found_keys.size() == 4096);
    REQUIRE(found_ids.size() == 4096);
    for (std::size_t i = 0; i < 4096; ++i)
        REQUIRE(host.records()[i] == Item{found_keys[i], found_ids[i]});
}

TEST_CASE("packed lists that are mostly empty keep their places") {
    CELLIST_EACH_STORAGE(storage);
    CELLIST_RANDOM(random, 211u);
    for (const cl_uint cell : {0u, 4095u, 4096u, 4097u, 8192u, 9999u}) {
        INFO("cell " << cell);
        Lists<Item> lists(device(), {10'000}, {.storage = storage});
        Inserts<Item> inserts = random_inserts(93, 1, random);
        for (cl_uint& to : inserts.cells) to = cell;
        Inserter(lists).build(lists, inserts);
        require_packed(lists, oracle_of(inserts, 10'000));
    }
}

TEST_CASE("packed lists that were dropped from hold what was stored") {
    CELLIST_EACH_STORAGE(storage);
    CELLIST_RANDOM(random, 212u);
    Lists<Item> lists(
        device(), {50},
        {.storage = storage, .overflow = Overflow::drop, .capacity_nodes = 93, .slots = 2});
    const BuildReport report = Inserter(lists).build(lists, random_inserts(144, 50, random));
    REQUIRE(report.dropped > 0);
    const Packed<Item> packed = lists.pack();
    REQUIRE(packed.records.size() == report.stored);
    REQUIRE(packed.records.download() == lists.download().records());
}

TEST_CASE("lists without cells are packed as one offset") {
    CELLIST_EACH_STORAGE(storage);
    for (const Shape& shape : {Shape{0}, Shape{7, 0}}) {
        Lists<Item> lists(device(), shape, {.storage = storage});
        CELLIST_RANDOM(random, 213u);
        Inserter(lists).build(lists, random_inserts(7, 10, random));
        const Packed<Item> packed = lists.pack();
        REQUIRE(packed.offsets.download() == std::vector<cl_uint>{0});
        REQUIRE(packed.records.size() == 0);
    }
}

TEST_CASE("packed lists outlive the container and later builds") {
    CELLIST_EACH_STORAGE(storage);
    CELLIST_RANDOM(random, 214u);
    const Inserts<Item> inserts = random_inserts(144, 50, random);
    std::optional<Packed<Item>> packed;
    std::optional<HostLists<Item>> host;
    {
        Lists<Item> lists(device(), {50}, {.storage = storage});
        Inserter inserter(lists);
        inserter.build(lists, inserts);
        packed = lists.pack();
        host = lists.download();
        inserter.build(lists, random_inserts(500, 50, random));
    }
    REQUIRE(packed->records.download() == host->records());
}

}  // namespace
}  // namespace cellist::test
