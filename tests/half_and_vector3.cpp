// SPDX-License-Identifier: MIT
// Halves are ordered as floats, and the fourth component of a 3-vector takes no part in any order.
#include <bit>
#include <cmath>
#include <limits>

#include "support/internals.hpp"
#include "support/sorted.hpp"

namespace cellist::test {
namespace {

struct Splat {
    Half opacity;
    cl_ushort id;
};
CELLIST_STRUCT(Splat, opacity, id);

auto members(const Splat& splat) {
    return std::tuple(ordered(splat.opacity.to_float()), splat.opacity.bits, splat.id);
}

/// The order of halves in floats. Conversions keep the signs and payloads of NaNs.
cl_float opacity_of(const Splat& splat) { return splat.opacity.to_float(); }

TEST_CASE("halves are sorted as floats, with every value of the type") {
    // Fixed lists are sorted as counted ones.
    const Storage storage = GENERATE(Storage::linked, Storage::counted);
    const cl_device_type division =
        GENERATE(cl_device_type{CL_DEVICE_TYPE_CPU}, cl_device_type{CL_DEVICE_TYPE_GPU});
    CELLIST_RANDOM(random, 210u);
    Inserts<Splat> inserts;
    for (cl_uint bits = 0; bits < 0x10000; ++bits) {
        // Quiet NaNs alone: hosts may make others quiet.
        if ((bits & 0x7C00u) == 0x7C00u && (bits & 0x3FFu) != 0 && (bits & 0x200u) == 0) continue;
        const Splat splat{{static_cast<cl_half>(bits)}, static_cast<cl_ushort>(bits * 7)};
        inserts.add(bits % 97 == 0 ? 0 : 1 + below(random, 1500), splat);
    }
    constexpr std::uint64_t cells = 1501;
    Lists<Splat> lists(device(), {cells}, {.storage = storage});
    sort_as_on(lists, division);
    Inserter(lists).build(lists, inserts);
    for (const Order order : all_orders) {
        lists.sort(&Splat::opacity, order);
        REQUIRE(same_bits(lists.download(),
                          sorted_lists(inserts, cells, before<Splat>(opacity_of, order))));
    }
    lists.sort_async(&Splat::opacity);
    REQUIRE(same_bits(lists.download(), sorted_lists(inserts, cells, before<Splat>(opacity_of))));
    // Ids are unique, so halves decide no ties.
    lists.sort_by("cellist_half_to_float(record.opacity) < cellist_half_to_float(least)",
                  {{"least", Half::of(0.5f)}}, Order::descending);
    const auto list = lists.download().cell(0);
    REQUIRE(list.front().opacity.to_float() < 0.5f);
    REQUIRE_FALSE(list.back().opacity.to_float() < 0.5f);
}

TEST_CASE("kernels convert halves and keep the nearest by them") {
    Lists<Splat> lists(device(), {1}, {.storage = nearest(&Splat::opacity, 4)});
    Kernel insert(device(), R"(
#include <cellist/lists.clh>
kernel void insert(CELLIST_LISTS(Splat, splats))
{
    const uint i = get_global_id(0);
    Splat splat = { cellist_float_to_half(100.0f - (float)i * 0.5f), i };
    splat.id += cellist_half_to_float(splat.opacity) == 100.0f - (float)i * 0.5f ? 1000 : 0;
    cellist_insert(splats, 0, splat);
}
)",
                  "insert", lists);
    lists.build(insert, 200);
    lists.sort(&Splat::opacity);
    const auto found = lists.download().records();
    REQUIRE(found.size() == 4);
    for (cl_ushort i = 0; i < 4; ++i) {
        REQUIRE(found[i].opacity.to_float() == 0.5f + 0.5f * static_cast<float>(i));
        REQUIRE(found[i].id == 1199 - i);
    }
}

struct Placed {
    Vector3<cl_float> at;
    cl_uint id;
};
CELLIST_STRUCT(Placed, at, id);

TEST_CASE("the fourth component of a 3-vector takes no part in ties") {
    const Storage storage = GENERATE(Storage::linked, Storage::counted);
    CELLIST_RANDOM(random, 211u);
    constexpr cl_uint count = 1500;
    Lists<Placed> lists(device(), {3}, {.storage = storage});
    // Writes the padding, in another order than that of the ids.
    Kernel insert(device(), R"(
#include <cellist/lists.clh>
kernel void insert(CELLIST_LISTS(Placed, points), uint count)
{
    const uint i = get_global_id(0);
    const uint id = i * 7 % count;
    Placed point = { (float3)(id % 2, id % 3, 4), id };
    ((float*)&point.at)[3] = (float)(count - id);
    cellist_insert(points, id < 100 ? 0 : id < 300 ? 1 : 2, point);
}
)",
                  "insert", lists);
    lists.build(insert, count, count);
    const auto require_order = [&](auto before) {
        const HostLists<Placed> found = lists.download();
        REQUIRE(found.records().size() == count);
        for (std::uint64_t cell = 0; cell < 3; ++cell) {
            const auto list = found.cell(cell);
            for (std::size_t i = 1; i < list.size(); ++i) REQUIRE(before(list[i - 1], list[i]));
        }
    };
    const auto members_of = [](const Placed& p) {
        return std::tuple(p.at.x, p.at.y, p.at.z, p.id);
    };
    lists.sort_by("record.at.z");
    require_order([&](const Placed& a, const Placed& b) { return members_of(a) < members_of(b); });
    lists.sort_by_async("record.at.y");
    require_order([&](const Placed& a, const Placed& b) {
        return std::tuple(a.at.y, members_of(a)) < std::tuple(b.at.y, members_of(b));
    });
    // A value is such a vector as well: distances have three components.
    lists.sort_by("distance(record.at, query)", {{"query", Vector3<cl_float>{1, 2, 4}}});
    require_order([&](const Placed& a, const Placed& b) {
        const auto square = [](const Placed& p) {
            return (p.at.x - 1) * (p.at.x - 1) + (p.at.y - 2) * (p.at.y - 2);
        };
        return std::tuple(square(a), members_of(a)) < std::tuple(square(b), members_of(b));
    });
    const std::vector<Vector3<cl_float>> packed = lists.pack(&Placed::at).records.download();
    REQUIRE(packed.size() == count);
    REQUIRE(packed.front().z == 4);
}

}  // namespace
}  // namespace cellist::test
