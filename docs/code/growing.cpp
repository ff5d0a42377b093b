// SPDX-License-Identifier: MIT
#include <cellist/cellist.hpp>

#include "check.hpp"

struct Spark {
    cl_float x, y;
    cl_float age;
};
CELLIST_STRUCT(Spark, x, y, age);

constexpr auto source = R"(
#include <cellist/lists.clh>

kernel void emit(CELLIST_LISTS(Spark, sparks), float x)
{
    uint i = get_global_id(0);
    Spark spark = { x, i % 8, i };
    cellist_insert(sparks, cellist_cell2(sparks, spark.x, spark.y), spark);
}

kernel void crowded(CELLIST_LISTS(Spark, sparks), uint most, global uint* crowded)
{
    uint cell = get_global_id(0);
    crowded[cell] = cellist_length(sparks, cell) > most;
}
)";

int main() {
    cellist::Device device = cellist::Device::choose();
    cellist::Lists<Spark> sparks(device, {8, 8});
    cellist::Kernel emit(device, source, "emit", sparks);

    sparks.build(emit, 1000, 1.0f);
    cellist::BuildReport report = sparks.append(emit, 10, 2.0f);
    std::cout << report.existing << " + " << report.attempted << " = " << report.stored << '\n';
    check(report.existing == 1000 && report.attempted == 10 && report.stored == 1010, "append");

    std::uint64_t removed = sparks.remove_if("record.age > limit", {{"limit", 499.0f}});
    check(removed == 500, "half of the first sparks are too old");

    cellist::Lists<Spark> before = sparks.copy();
    sparks.merge(before);
    check(sparks.lengths().total == 2 * before.lengths().total, "merge");

    cellist::Buffer<cl_uint> lengths = sparks.device_lengths();
    cellist::Buffer<cl_uint> offsets = sparks.device_offsets();        // their prefix sums
    cellist::Buffer<cl_uint> histogram = sparks.device_histogram(16);  // cells by length
    check(lengths.download()[1] == 126, "a column has an eighth of the sparks");
    check(offsets.download().back() == 1020, "all sparks");
    check(histogram.download()[0] == 48, "six columns are empty");

    cellist::Buffer<cl_uint> is_crowded(device, sparks.shape().cells());
    cellist::Kernel crowded(device, source, "crowded", sparks);
    crowded.run(sparks.shape().cells(), sparks, cl_uint{100}, is_crowded);
    check(is_crowded.download()[1] == 1 && is_crowded.download()[2] == 0, "crowded cells");
    std::cout << "growing: ok\n";
}
