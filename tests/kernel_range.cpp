// SPDX-License-Identifier: MIT
// A range launches exactly its work-items.
#include "support/errors.hpp"
#include "support/inserts.hpp"

namespace cellist::test {
namespace {

constexpr auto visit_source = R"(
kernel void visit(global uint* visits, uint size)
{
    const uint x = get_global_id(0), y = get_global_id(1), z = get_global_id(2);
    const uint i = x + get_global_size(0) * (y + get_global_size(1) * z);
    atomic_inc(&visits[min(i, size)]);
    if (x == 0 && y == 0 && z == 0) {
        visits[size + 1] = get_work_dim();
        visits[size + 2] = get_local_size(0);
    }
}
)";

TEST_CASE("every range runs exactly its work-items, primes and empty ranges too") {
    Kernel kernel(device(), visit_source, "visit");
    for (const Range& range :
         {Range(0), Range(1), Range(7), Range(64), Range(101), Range(1000), Range(7919),
          Range(65'537), Range(0, 5), Range(5, 0), Range(13, 17), Range(1, 97), Range(97, 1),
          Range(64, 33), Range(640, 7), Range(3, 5, 7), Range(16, 16, 3), Range(1, 1, 101),
          Range(4, 0, 4)}) {
        const std::size_t size = range.global[0] * range.global[1] * range.global[2];
        INFO("range " << range.global[0] << " x " << range.global[1] << " x " << range.global[2]);
        Buffer<cl_uint> visits(device(), size + 3);
        visits.fill(0);
        const cl::Event event = kernel.run(range, visits, static_cast<cl_uint>(size));
        event.wait();
        std::vector<cl_uint> host = visits.download();
        if (size > 0) REQUIRE(host[size + 1] == range.dimensions);
        REQUIRE(host[size] == 0);
        host.resize(size);
        REQUIRE(std::count(host.begin(), host.end(), 1u) == static_cast<std::ptrdiff_t>(size));
    }
}

TEST_CASE("a range with a local size runs in such work-groups") {
    Kernel kernel(device(), visit_source, "visit");
    Range range(96);
    range.local = {32, 1, 1};
    Buffer<cl_uint> visits(device(), 99);
    visits.fill(0);
    kernel.run(range, visits, cl_uint{96});
    REQUIRE(visits.download()[98] == 32);
}

TEST_CASE("a padded range is the next multiple of the work-group") {
    REQUIRE(Range::padded(0).global[0] == 0);
    REQUIRE(Range::padded(1).global[0] == 256);
    REQUIRE(Range::padded(256).global[0] == 256);
    REQUIRE(Range::padded(257).global[0] == 512);
    REQUIRE(Range::padded(100, 64).global[0] == 128);
    REQUIRE(Range::padded(100, 64).local[0] == 64);
}

TEST_CASE("an impossible work-group is an error and leaves the kernel usable") {
    Kernel kernel(device(), visit_source, "visit");
    Buffer<cl_uint> visits(device(), 103);
    Range range(100);
    range.local = {std::size_t{1} << 30, 1, 1};
    const auto error = error_of<OpenClError>([&] { kernel.run(range, visits, cl_uint{100}); });
    INFO(error.what());
    REQUIRE(error.call() == "clEnqueueNDRangeKernel");
    REQUIRE(contains(error.what(), "CL_INVALID_WORK_GROUP_SIZE"));
    REQUIRE(contains(error.what(),
                     "the work-groups of 1073741824 work-items exceed the limit of " +
                         std::to_string(kernel.cl().getWorkGroupInfo<CL_KERNEL_WORK_GROUP_SIZE>(
                             device().queue().getInfo<CL_QUEUE_DEVICE>()))));
    REQUIRE(contains(error.what(), "kernel visit"));
    kernel.run(100, visits, cl_uint{100});
    device().finish();
}

TEST_CASE("the message of a bad work-group names its size and what it does not fit") {
    const std::string header = "kernel __attribute__((reqd_work_group_size(16, 1, 1))) ";
    Kernel any(device(), visit_source, "visit");
    Kernel exact(device(), header + "void f(global uint* out) { *out = 1; }", "f");
    const Buffer<cl_uint> visits(device(), 200);
    const auto message = [&](Kernel& launched, const Range& range, const auto&... arguments) {
        const auto error = error_of<OpenClError>([&] { launched.run(range, arguments...); });
        return std::string(error.what());
    };
    const cl_uint size = 100;
    Range range(100);
    range.local = {32, 0, 0};
    REQUIRE(contains(message(any, range, visits, size),
                     "the work-groups of 32 work-items do not divide the range of 100: see "
                     "Range::padded"));
    range.local = {std::size_t{1} << 30, 0, 0};
    REQUIRE(contains(message(any, range, visits, size), "exceed the limit of"));
    Range plane(8, 9);
    plane.local = {8, 2, 1};
    REQUIRE(contains(message(any, plane, visits, size),
                     "of 8x2 work-items do not divide the range of 8x9"));
    REQUIRE(contains(message(exact, Range::padded(64, 32), visits),
                     "of 32 work-items are not the 16 that kernel f requires"));
    REQUIRE(contains(message(exact, Range(100), visits),
                     "kernel f requires work-groups of 16, which do not divide the range of 100"));
}

TEST_CASE("a range that cannot be is refused, naming it") {
    Kernel kernel(device(), "kernel void f(global uint* out) { *out = 1; }", "f");
    const Buffer<cl_uint> out(device(), 1);
    REQUIRE(contains(error_of([&] { kernel.run(-1, out); }).what(), "-1"));
    REQUIRE(contains(error_of([&] { kernel.run({4, -7}, out); }).what(), "-7"));
    REQUIRE_THROWS_AS(Range::padded(-5), Error);
    REQUIRE_THROWS_AS(Range::padded(5, 0), Error);
    REQUIRE_THROWS_AS(Range::padded(~std::uint64_t{0}), Error);
    Range partly(8, 8);
    partly.local = {8, 0, 0};
    REQUIRE_THROWS_AS(kernel.run(partly, out), Error);
}

TEST_CASE("a kernel that requires a work-group size gets it") {
    Kernel kernel(device(),
                  "kernel __attribute__((reqd_work_group_size(16, 1, 1))) void f(global uint* out)"
                  "{ out[get_global_id(0)] = get_local_size(0); }",
                  "f");
    const Buffer<cl_uint> out(device(), 64);
    kernel.run(64, out);
    for (const cl_uint size : out.download()) REQUIRE(size == 16);
}

}  // namespace
}  // namespace cellist::test
