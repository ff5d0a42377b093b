// SPDX-License-Identifier: MIT
// A struct whose layouts differ, or that is called like another, is refused.
#include "support/errors.hpp"
#include "support/inserts.hpp"

namespace cellist::test {

/// Three floats, which the specialisation below passes off as a float3. That takes 16 bytes.
struct Triple {
    cl_float x, y, z;
};

}  // namespace cellist::test

namespace cellist {

template <>
struct DeviceType<test::Triple> {
    static constexpr std::size_t size = 12;
    static constexpr std::size_t alignment = 4;
    static std::string name() { return "float3"; }
    static void define(detail::Definitions&) {}
    static void add_scalars(const std::string& path, std::vector<std::string>& scalars) {
        for (const char* name : {".x", ".y", ".z"}) scalars.push_back(path + name);
    }
};

}  // namespace cellist

namespace cellist::test {
namespace {

struct WrongSize {
    Triple position;
};
CELLIST_STRUCT(WrongSize, position);

struct WrongOffset {
    Triple position;
    cl_float weight;
};
CELLIST_STRUCT(WrongOffset, position, weight);

template <class T>
std::string refusal() {
    return error_of([] {
               Lists<T> lists(device(), {5});
               Kernel(device(), insert_source(DeviceType<T>::name()), "insert_all", lists);
           })
        .what();
}

TEST_CASE("a struct whose layout differs on the device is refused, naming the struct") {
    const std::string size = refusal<WrongSize>();
    INFO(size);
    REQUIRE(contains(size, "layout"));
    REQUIRE(contains(size, "WrongSize"));
    const std::string offset = refusal<WrongOffset>();
    INFO(offset);
    REQUIRE(contains(offset, "layout"));
    REQUIRE(contains(offset, "WrongOffset"));
    REQUIRE_THROWS_AS(
        Kernel(device(), "kernel void nothing(uint parameter) {}", "nothing", type<WrongOffset>),
        Error);
}

namespace first {
struct Twin {
    cl_float key;
};
CELLIST_STRUCT(Twin, key);
}  // namespace first
namespace second {
struct Twin {
    cl_uint key;
};
CELLIST_STRUCT(Twin, key);
}  // namespace second
namespace third {
struct Twin {
    cl_float key;
};
CELLIST_STRUCT(Twin, key);
}  // namespace third

TEST_CASE("different structs of one name are refused in one kernel") {
    constexpr auto source = "kernel void nothing(global Twin* twins) { twins->key = 3; }";
    const auto error = error_of(
        [&] { Kernel(device(), source, "nothing", type<first::Twin>, type<second::Twin>); });
    INFO(error.what());
    REQUIRE(contains(error.what(), "Twin"));
    Kernel(device(), source, "nothing", type<first::Twin>, type<third::Twin>);
    Kernel(device(), source, "nothing", type<second::Twin>);
}

}  // namespace
}  // namespace cellist::test
