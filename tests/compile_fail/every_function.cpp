// SPDX-License-Identifier: MIT
// Compiles without a warning, whatever the user's flags: every public header, and every function
// template. The flags stand in CMakeLists.txt.
#include <cellist/buffer.hpp>
#include <cellist/cellist.hpp>
#include <cellist/device.hpp>
#include <cellist/error.hpp>
#include <cellist/host_lists.hpp>
#include <cellist/kernel.hpp>
#include <cellist/lists.hpp>
#include <cellist/opencl.hpp>
#include <cellist/options.hpp>
#include <cellist/pending.hpp>
#include <cellist/range.hpp>
#include <cellist/report.hpp>
#include <cellist/shape.hpp>
#include <cellist/struct.hpp>
#include <cellist/types.hpp>
#include <cellist/value.hpp>
#if __has_include(<glm/glm.hpp>)
#include <cellist/glm.hpp>
#endif

// Two members of each type, and globals that are called like them.
struct Corner {
    cl_short2 at;
    cl_uchar tag;
};
CELLIST_STRUCT(Corner, at, tag);

struct Hit {
    cl_float depth, weight;
    cl_uint id, next;
    cl_ulong time;
    cl_float4 colour, normal;
    cl_ushort grid[2][3];
    Corner corners[2];
};
CELLIST_STRUCT(Hit, depth, weight, id, next, time, colour, normal, grid, corners);

struct Photon {
    Photon() = default;
    explicit Photon(cl_uint value) : id(value) {}
    cl_uint id = 0;
    cl_float power = 0;
};
CELLIST_STRUCT(Photon, id, power);

int depth = 0;
int id = 0;

std::size_t use(const cellist::Device& device) {
    using namespace cellist;
    const Buffer<cl_float> numbers(device, std::vector<cl_float>{1, 2});
    Buffer<Hit> records(device, 3);
    records.fill({});
    std::size_t sum = records.size() + records.download().size() +
                      records.download_async().get().size() + numbers.size();
    const std::vector<Hit> values(3);
    records.upload(values);
    records.upload(values, 0);
    records.upload_async(values).wait();
    records.upload_async(values, 0).wait();
    sum += records.download(1, 2).size() + records.download_async(1, 2).get().size();

    Lists<Hit> hits(device, {4, 3},
                    {.storage = Storage::counted, .capacity_nodes = 7, .periodic = {true}});
    Lists<Photon> photons(device, {4});
    const Source source{.text = "kernel void f(CELLIST_LISTS(Hit, hits), uint n) {}"};
    Kernel kernel(device, source, "f", hits, photons, type<Corner>);
    Kernel other(device, "kernel void f(CELLIST_LISTS(Hit, hits), uint n) {}", "f", hits);
    sum += kernel.name().size() + kernel.log().size() + (kernel.cl()() != nullptr ? 1U : 0U);
    const int width = 4;
    sum += Shape{width, 3U, std::size_t{2}}.cell({width - 1, 2});
    device.prepare([&] { hits.build(kernel, 7, cl_uint{3}); });
    device.prepare([] {}, [&](std::size_t programs) { sum += programs; });
    sum += hits.build(kernel, 7, cl_uint{3}).stored;
    sum += hits.build([&] { kernel.run({2, 3}, hits, cl_uint{3}); }).stored;
    sum += hits.build_async(kernel, Range::padded(7), cl_uint{3}).get().stored;
    sum += hits.build_async([&] { kernel.run(7, hits, cl_uint{3}); }).get().stored;
    sum += hits.build_slices([&] { kernel.run(7, hits, cl_uint{3}); },
                             [&](const Slice& slice) { sum += slice.cells; })
               .stored;
    const auto insert = [&] {
        kernel.run(7, hits, photons, LocalMemory{64}, records, numbers.cl());
    };
    sum += build(insert, hits, photons)[0].stored;
    sum += build_async(insert, hits, photons).get()[1].stored;

    hits.sort(&Hit::depth);
    hits.sort(&Hit::time, Order::descending).wait();
    hits.sort_by("record.depth");
    hits.sort_by("record.depth * scale", {{"scale", 2.0f}});
    hits.sort_by("record.id ^ mask", Values{{"mask", cl_uint{3}}}, Order::descending);
    hits.partial_sort_by("distance(record.colour, query)", {{"query", cl_float4{}}}, 3);
    hits.sort_by_async("record.depth < corner.tag", {{"corner", Corner{}}}, Order::descending);
    hits.partial_sort(&Hit::id, 3);
    hits.partial_sort_by("record.id", 3, Order::descending);
    hits.sort_async(&Hit::weight);
    hits.sort_by_async("record.depth");
    photons.sort(&Photon::power);

    sum += hits.append(kernel, 7, cl_uint{3}).stored;
    sum += hits.append_async(kernel, Range::padded(7), cl_uint{3}).get().stored;
    sum += hits.append([] {}).existing + hits.append_async([] {}).get().stored;
    sum += hits.merge(hits.copy()).stored + hits.remove_if("record.id > most", {{"most", 7U}});
    sum += hits.device_lengths().size() + hits.device_offsets().size() +
           hits.device_histogram(8).size();
    sum += hits.lengths().total + hits.lengths_async().get().longest;
    sum += hits.download().records().size() + hits.download_async().get()[{1, 2}].size();
    sum += hits.pack().records.size() + hits.pack(&Hit::next).records.size() +
           hits.pack(&Hit::colour).records.size() + hits.pack(&Hit::grid).records.size() +
           hits.pack(&Hit::corners).offsets.size();
    Neighbours near = hits.neighbours({.distance = "distance(record.colour, other.colour)"});
    near = hits.neighbours(&Hit::id,
                           {.distance = "fabs(record.depth - other.depth) * scale",
                            .radius = 0.5F,
                            .radius_cells = 2,
                            .values = {{"scale", 2.0F}}},
                           std::move(near));
    Nearest<Hit> first =
        hits.nearest(numbers, {.k = 3, .position = "query", .distance = "record.depth"});
    first = hits.nearest(records, {.position = "query.grid[0][0]", .distance = "query.depth"},
                         std::move(first));
    Lists<cl_uint> ids(device, {4}, {.storage = nearest<cl_uint>(3)});
    Kernel add(device, "kernel void f(CELLIST_LISTS(uint, ids)) {}", "f", ids, type<cl_float4>);
    sum += ids.build(add, 7).stored + ids.download().cell(0).size() + ids.pack().records.size();
    ids.sort();
    ids.sort(Order::descending);
    ids.partial_sort(3);
    ids.sort_async();
    sum += near.pairs + near.indices.size() + first.records.size();
    sum += hits.validate().ok() && hits.validate_async().get().ok() ? 1U : 0U;
    hits.clear();
    Lists<Hit> moved(std::move(hits));
    moved = Lists<Hit>(device, {1});
    return sum + moved.shape().cells() + moved.capacity_nodes() + moved.pool_bytes() +
           moved.storage_reason().size() + (moved.storage() == Storage::fixed ? 1U : 0U);
}
