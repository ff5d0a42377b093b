// SPDX-License-Identifier: MIT
// Records with equal keys are ordered by their members, whichever member decides, in every list.
#include <bit>
#include <cmath>
#include <limits>

#include "support/internals.hpp"
#include "support/sorted.hpp"
#include "support/storages.hpp"

namespace cellist::test {
namespace {

/// A record whose ties may be decided by any member.
struct Tied {
    cl_float height;
    cl_uint first;
    cl_ulong wide;
    cl_short small[6];  // without padding, which has undefined bits
    cl_float last;
};
CELLIST_STRUCT(Tied, height, first, wide, small, last);

auto members(const Tied& r) {
    return std::tuple(ordered(r.height), r.first, r.wide, r.small[0], r.small[1], r.small[2],
                      r.small[3], r.small[4], r.small[5], ordered(r.last));
}

constexpr std::array<cl_uint, 13> tie_lengths{0, 1, 2, 7, 9, 16, 33, 64, 129, 256, 257, 300, 600};

/// Lists of these lengths, each twice: some are sorted after others with ties.
template <class Make>
Inserts<Tied> tied_inserts(std::mt19937& random, Make make) {
    Inserts<Tied> inserts;
    for (cl_uint cell = 0; cell < 2 * tie_lengths.size(); ++cell)
        for (cl_uint i = 0; i < tie_lengths[cell % tie_lengths.size()]; ++i)
            inserts.add(cell, make(cell));
    inserts.shuffle(random);
    return inserts;
}

/// Requires that sorts by members and expressions, in each division of the work, give the lists of
/// a stable sort on the host.
void require_ties_sorted(const Inserts<Tied>& inserts) {
    // Fixed lists are sorted as counted ones.
    const Storage storage = GENERATE(Storage::linked, Storage::counted);
    const cl_device_type division =
        GENERATE(cl_device_type{CL_DEVICE_TYPE_CPU}, cl_device_type{CL_DEVICE_TYPE_GPU});
    INFO("storage " << name_of(storage) << ", division " << division);
    const std::uint64_t cells = 2 * tie_lengths.size();
    Lists<Tied> lists(device(), {cells}, {.storage = storage});
    sort_as_on(lists, division);
    Inserter(lists).build(lists, inserts);
    const auto require_sort = [&](const char* name, auto sort, auto key, Order order) {
        INFO(name << ", " << name_of(order));
        sort(order);
        REQUIRE(
            same_bits(lists.download(), sorted_lists(inserts, cells, before<Tied>(key, order))));
    };
    require_sort(
        "by a member", [&](Order o) { lists.sort(&Tied::height, o); }, &Tied::height,
        Order::ascending);
    require_sort(
        "by an expression of 32 bits",
        [&](Order o) {
            lists.sort_by("fabs(record.height - c)", {{"c", 1.0f}}, o);
        },
        [](const Tied& r) { return std::abs(r.height - 1.0f); }, Order::descending);
    require_sort(
        "by an expression of 64 bits", [&](Order o) { lists.sort_by("record.wide / 2", o); },
        [](const Tied& r) { return r.wide / 2; }, Order::descending);
    require_sort(
        "by a member of 64 bits", [&](Order o) { lists.sort(&Tied::wide, o); }, &Tied::wide,
        Order::ascending);
    require_sound(lists, inserts.size());
}

TEST_CASE("ties are decided by any member") {
    CELLIST_RANDOM(random, 200u);
    require_ties_sorted(tied_inserts(random, [&](cl_uint) {
        // Few values each, so that every member decides now and then.
        Tied r{};
        r.height = static_cast<cl_float>(below(random, 3));
        r.first = below(random, 2) * 0x80000000u;
        r.wide = below(random, 2) * 0x8000000000000000u + below(random, 2);
        for (cl_short& small : r.small) small = static_cast<cl_short>(below(random, 2) - 1);
        r.last = static_cast<cl_float>(below(random, 2));
        return r;
    }));
}

TEST_CASE("ties are decided by the second member after lists where the first one was constant") {
    CELLIST_RANDOM(random, 201u);
    require_ties_sorted(tied_inserts(random, [&](cl_uint cell) {
        Tied r{};
        r.height = static_cast<cl_float>(below(random, 5));
        r.first = cell < 13 ? 7 : below(random, 4);
        r.wide = below(random, 1000);
        r.last = static_cast<cl_float>(below(random, 1000));
        return r;
    }));
}

TEST_CASE("ties are decided by the last member alone, or by none") {
    CELLIST_RANDOM(random, 202u);
    require_ties_sorted(tied_inserts(random, [&](cl_uint cell) {
        Tied r{};
        r.last = static_cast<cl_float>(cell % 2 == 0 ? 3 : below(random, 40));
        return r;
    }));
}

TEST_CASE("ties of extreme values are decided bit by bit") {
    CELLIST_RANDOM(random, 203u);
    constexpr cl_float infinity = std::numeric_limits<cl_float>::infinity();
    const cl_float nan = std::bit_cast<cl_float>(0x7FC00000u);
    const std::array<cl_float, 10> extremes{nan,
                                            std::bit_cast<cl_float>(0xFFC00000u),
                                            std::bit_cast<cl_float>(0x7FC00001u),
                                            infinity,
                                            -infinity,
                                            0.0f,
                                            -0.0f,
                                            std::numeric_limits<cl_float>::denorm_min(),
                                            std::numeric_limits<cl_float>::max(),
                                            std::numeric_limits<cl_float>::lowest()};
    const auto any = [&] { return extremes[below(random, extremes.size())]; };
    CELLIST_EACH_STORAGE(storage);
    Inserts<Tied> inserts = tied_inserts(random, [&](cl_uint) {
        Tied r{};
        r.height = any();
        r.wide = below(random, 2) == 0 ? 0 : ~cl_ulong{0};
        r.last = any();
        return r;
    });
    Lists<Tied> lists(device(), {2 * tie_lengths.size()}, {.storage = storage});
    Inserter(lists).build(lists, inserts);
    for (const Order order : all_orders) {
        lists.sort(&Tied::height, order);
        REQUIRE(same_bits(lists.download(), sorted_lists(inserts, 2 * tie_lengths.size(),
                                                         before<Tied>(&Tied::height, order))));
    }
}

struct OneMember {
    cl_uint key;
};
CELLIST_STRUCT(OneMember, key);
auto members(const OneMember& r) { return std::tuple(r.key); }

TEST_CASE("records of one member tie only where they are the same") {
    CELLIST_EACH_STORAGE(storage);
    CELLIST_RANDOM(random, 204u);
    Inserts<OneMember> inserts;
    for (cl_uint i = 0; i < 3000; ++i) inserts.add(below(random, 20), {below(random, 9)});
    for (cl_uint i = 0; i < 1000; ++i) inserts.add(20, {below(random, 9)});
    Lists<OneMember> lists(device(), {21}, {.storage = storage});
    Inserter(lists).build(lists, inserts);
    lists.sort(&OneMember::key);
    REQUIRE(
        same_bits(lists.download(), sorted_lists(inserts, 21, before<OneMember>(&OneMember::key))));
    lists.sort_by("record.key % 2");
    REQUIRE(same_bits(lists.download(),
                      sorted_lists(inserts, 21, before<OneMember>([](const OneMember& r) {
                                       return r.key % 2;
                                   }))));
}

}  // namespace
}  // namespace cellist::test
