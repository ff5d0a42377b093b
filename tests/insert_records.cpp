// SPDX-License-Identifier: MIT
// Records of any size and alignment come back byte for byte.
#include "support/inserts.hpp"
#include "support/storages.hpp"

namespace cellist::test {
namespace {

struct One {
    cl_uchar byte;
};
CELLIST_STRUCT(One, byte);
struct Three {
    cl_uchar bytes[3];
};
CELLIST_STRUCT(Three, bytes);
struct Four {
    cl_char a;
    cl_uchar b;
    cl_short c;
};
CELLIST_STRUCT(Four, a, b, c);
struct Eight {
    cl_ulong value;
};
CELLIST_STRUCT(Eight, value);
struct Twelve {
    cl_uint id;
    cl_float pair[2];
};
CELLIST_STRUCT(Twelve, id, pair);
struct Sixteen {
    cl_float4 value;
};
CELLIST_STRUCT(Sixteen, value);
struct Twenty {
    Twelve inner;
    cl_short grid[2][2];
};
CELLIST_STRUCT(Twenty, inner, grid);
struct TwentyEight {
    cl_int values[7];
};
CELLIST_STRUCT(TwentyEight, values);
struct SixtyFour {
    cl_float16 value;
};
CELLIST_STRUCT(SixtyFour, value);
struct Hundred {
    Twenty inner[2];
    cl_uint rest[15];
};
CELLIST_STRUCT(Hundred, inner, rest);

template <class T>
void round_trip(std::size_t expected_bytes, std::size_t expected_node_bytes,
                Storage storage = Storage::linked) {
    INFO("storage " << name_of(storage));
    REQUIRE(sizeof(T) == expected_bytes);
    CELLIST_RANDOM(random, 20u + static_cast<unsigned>(sizeof(T)));
    for (const std::size_t count : {0u, 1u, 144u, 5000u}) {
        INFO(DeviceType<T>::name() << ", " << count << " records");
        Inserts<T> inserts;
        for (std::size_t i = 0; i < count; ++i) {
            T record;
            auto* bytes = reinterpret_cast<unsigned char*>(&record);
            for (std::size_t at = 0; at < sizeof record; ++at)
                bytes[at] = static_cast<unsigned char>(below(random, 256));
            inserts.add(below(random, 31), record);
        }
        Lists<T> lists(device(), {29}, {.storage = storage, .capacity_nodes = 100});
        const std::uint64_t without_nodes =
            lists.pool_bytes() - lists.capacity_nodes() * expected_node_bytes;
        REQUIRE(without_nodes < 2 * 29 * 4 + 1024);
        const Oracle<T> oracle = oracle_of(inserts, 29);
        require_complete(Inserter(lists).build(lists, inserts), oracle.size(),
                         count - oracle.size());
        require_sound(lists, oracle.size());
        require_same(lists.download(), oracle);
    }
}

TEST_CASE("a record of 1 byte round-trips") { round_trip<One>(1, 8); }
TEST_CASE("a record of 3 bytes round-trips") { round_trip<Three>(3, 8); }
TEST_CASE("a record of 4 bytes round-trips") { round_trip<Four>(4, 8); }
TEST_CASE("a record of 8 bytes round-trips") { round_trip<Eight>(8, 16); }
TEST_CASE("a record of 12 bytes round-trips") { round_trip<Twelve>(12, 16); }
TEST_CASE("a record of 16 bytes round-trips") { round_trip<Sixteen>(16, 32); }
TEST_CASE("a record of 20 bytes round-trips") { round_trip<Twenty>(20, 24); }
TEST_CASE("a record of 28 bytes round-trips") { round_trip<TwentyEight>(28, 32); }
TEST_CASE("a record of 64 bytes round-trips") { round_trip<SixtyFour>(64, 128); }
TEST_CASE("a record of 100 bytes round-trips") { round_trip<Hundred>(100, 104); }

TEST_CASE("records of odd sizes round-trip without links") {
    const Storage storage = GENERATE(Storage::counted, Storage::fixed);
    round_trip<Three>(3, 3, storage);
    round_trip<Twelve>(12, 12, storage);
    round_trip<Hundred>(100, 100, storage);
}

TEST_CASE("a record may be a compound literal, or any expression of the struct", "[oclgrind]") {
    CELLIST_EACH_STORAGE(storage);
    Lists<Item> lists(device(), {3}, {.storage = storage});
    Kernel insert(device(), R"(
#include <cellist/lists.clh>
Item item_of(uint i) { return (Item){(float)i, i + 100u}; }
kernel void insert(CELLIST_LISTS(Item, lists), uint unused)
{
    const uint i = get_global_id(0);
    int stored = cellist_insert(lists, 0, (Item){(float)i, i});
    if (stored) cellist_insert(lists, 1, item_of(i));
    const Item left = {1.0f, 2u}, right = {3.0f, 4u};
    stored = cellist_insert(lists, 2, i % 2u == 0u ? left : right), stored += 1;
}
)",
                  "insert", lists);
    require_complete(lists.build(insert, 50, cl_uint{0}), 150);
    lists.sort(&Item::id);
    const HostLists<Item> found = lists.download();
    for (cl_uint i = 0; i < 50; ++i) {
        REQUIRE(found.cell(0)[i] == Item{static_cast<cl_float>(i), i});
        REQUIRE(found.cell(1)[i] == Item{static_cast<cl_float>(i), i + 100});
        REQUIRE(found.cell(2)[i] == (i < 25 ? Item{1.0f, 2} : Item{3.0f, 4}));
    }
}

}  // namespace
}  // namespace cellist::test
