// SPDX-License-Identifier: MIT
// pack() returns in device memory what download() returns in host memory.
#include <array>

#include "support/inserts.hpp"
#include "support/internals.hpp"
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

TEST_CASE("work-groups of a GPU pack short and long lists together") {
    CELLIST_EACH_STORAGE(storage);
    CELLIST_RANDOM(random, 214u);
    const Device gpu = like_gpu();
    Inserts<Item> inserts = random_inserts(5000, 300, random);
    for (cl_uint i = 0; i < 4500; ++i)
        inserts.add(i % 9 == 0 ? 130 : 255, {static_cast<cl_float>(i), 5000 + i});
    ListsOptions options{.storage = storage};
    if (has_slots(storage)) options.slots = 5000;
    Lists<Item> lists(gpu, {300}, options);
    Inserter(lists, gpu).build(lists, inserts);
    require_packed(lists, oracle_of(inserts, 300));
    const HostLists<Item> host = lists.download();
    const std::vector<cl_uint> ids = lists.pack(&Item::id).records.download();
    REQUIRE(ids.size() == host.records().size());
    for (std::size_t i = 0; i < ids.size(); ++i) REQUIRE(ids[i] == host.records()[i].id);
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

struct Corner {
    cl_uchar tag;
    cl_short2 at;
    friend bool operator==(const Corner& a, const Corner& b) {
        return a.tag == b.tag && a.at.s[0] == b.at.s[0] && a.at.s[1] == b.at.s[1];
    }
};
CELLIST_STRUCT(Corner, tag, at);

struct Shapes {
    cl_uint id;
    cl_float4 colour;
    cl_float weights[3];
    cl_ushort grid[2][3];
    Corner corner;
    Corner corners[2];
};
CELLIST_STRUCT(Shapes, id, colour, weights, grid, corner, corners);

TEST_CASE("vectors, arrays and structs are packed alone") {
    CELLIST_EACH_STORAGE(storage);
    Inserts<Shapes> inserts;
    for (cl_uint i = 0; i < 93; ++i) {
        Shapes shapes{};
        shapes.id = i;
        const auto value = [i](std::size_t n) { return static_cast<cl_short>(10 * i + n); };
        for (std::size_t n = 0; n < 4; ++n) shapes.colour.s[n] = value(n);
        for (std::size_t n = 0; n < 3; ++n) shapes.weights[n] = value(n);
        for (std::size_t n = 0; n < 6; ++n)
            shapes.grid[n / 3][n % 3] = static_cast<cl_ushort>(value(n));
        for (Corner* corner : {&shapes.corner, &shapes.corners[0], &shapes.corners[1]})
            *corner = {static_cast<cl_uchar>(i), {{value(1), value(2)}}};
        shapes.corners[1].at.s[0] = value(3);
        inserts.add(i % 7, shapes);
    }
    Lists<Shapes> lists(device(), {7}, {.storage = storage});
    Inserter(lists).build(lists, inserts);
    lists.sort(&Shapes::id);
    const std::vector<cl_uint> ids = lists.pack(&Shapes::id).records.download();
    const std::vector<cl_float4> colours = lists.pack(&Shapes::colour).records.download();
    const Packed<std::array<cl_float, 3>> packed_weights = lists.pack(&Shapes::weights);
    const std::vector<std::array<cl_float, 3>> weights = packed_weights.records.download();
    const std::vector<std::array<std::array<cl_ushort, 3>, 2>> grids =
        lists.pack(&Shapes::grid).records.download();
    const std::vector<Corner> corner = lists.pack(&Shapes::corner).records.download();
    const std::vector<std::array<Corner, 2>> corners =
        lists.pack(&Shapes::corners).records.download();
    REQUIRE(ids.size() == 93);
    std::size_t at = 0;
    for (cl_uint cell = 0; cell < 7; ++cell)
        for (cl_uint i = cell; i < 93; i += 7, ++at) {
            const Shapes& shapes = inserts.records[i];
            REQUIRE(ids[at] == i);
            REQUIRE(
                std::equal(std::begin(colours[at].s), std::end(colours[at].s), shapes.colour.s));
            REQUIRE(std::equal(weights[at].begin(), weights[at].end(), shapes.weights));
            for (std::size_t n = 0; n < 6; ++n)
                REQUIRE(grids[at][n / 3][n % 3] == shapes.grid[n / 3][n % 3]);
            REQUIRE(corner[at] == shapes.corner);
            REQUIRE(std::equal(corners[at].begin(), corners[at].end(), shapes.corners));
        }

    // A kernel takes them as it declares them.
    const Buffer<cl_float> sums(device(), 93);
    Kernel sum(device(),
               "kernel void sum(global const float* weights, global float* sums) {\n"
               "    const uint i = get_global_id(0);\n"
               "    sums[i] = weights[3 * i] + weights[3 * i + 1] + weights[3 * i + 2];\n}\n",
               "sum");
    sum.run(93, packed_weights.records, sums);
    REQUIRE(sums.download()[92] == weights[92][0] + weights[92][1] + weights[92][2]);
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
