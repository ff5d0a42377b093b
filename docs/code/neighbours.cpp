// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <utility>

#include <cellist/cellist.hpp>

#include "check.hpp"

struct Particle {
    cl_float x, y, z;
    cl_uint id;
};
CELLIST_STRUCT(Particle, x, y, z, id);

constexpr auto source = R"(
#include <cellist/lists.clh>

// The place of a particle, in cells.
float3 place_of(Particle p, float cell_size)
{
    return (float3)(p.x, p.y, p.z) / cell_size;
}

kernel void bin(CELLIST_LISTS(Particle, bins), global const Particle* particles, float cell_size)
{
    Particle p = particles[get_global_id(0)];
    float3 place = place_of(p, cell_size);
    cellist_insert(bins, cellist_cell3(bins, place.x, place.y, place.z), p);
}

// The number of particles within cell_size of each particle, in a periodic box.
kernel void crowd(CELLIST_LISTS(Particle, bins), global const Particle* particles, float cell_size,
                  float box, global uint* crowds)
{
    Particle p = particles[get_global_id(0)];
    uint count = 0;
    cellist_for_each_around(bins, cellist_position(place_of(p, cell_size)), 1, node) {
        Particle other = cellist_get(bins, node);
        if (other.id == p.id) continue;
        float3 apart = cellist_minimum_image((float3)(p.x - other.x, p.y - other.y, p.z - other.z),
                                             (float3)(box));
        if (cellist_norm(apart) <= cell_size) ++count;
    }
    crowds[get_global_id(0)] = count;
}

// The sum of the ids of each particle's neighbours.
kernel void sums(global const uint* offsets, global const uint* indices,
                 global const Particle* sorted, global uint* sums)
{
    uint i = get_global_id(0);
    uint sum = 0;
    for (uint n = offsets[i]; n < offsets[i + 1]; ++n) sum += sorted[indices[n]].id;
    sums[i] = sum;
}
)";

int main() {
    std::vector<Particle> host;
    for (cl_uint i = 0; i < 4000; ++i)
        host.push_back({cl_float(i * 7919 % 4001) / 4001, cl_float(i * 104729 % 3989) / 3989,
                        cl_float(i * 15485863 % 4003) / 4003, i});
    const float cell_size = 0.1F;
    const cl_float box = 1;

    cellist::Device device = cellist::Device::choose();
    cellist::Buffer<Particle> particles(device, host);

    cellist::Lists<Particle> bins(
        device, {10, 10, 10},
        {.storage = cellist::Storage::counted, .periodic = {true, true, true}});
    cellist::Kernel bin(device, source, "bin", bins);
    bins.build(bin, host.size(), particles, cell_size);

    cellist::Kernel crowd(device, source, "crowd", bins);
    cellist::Buffer<cl_uint> crowds(device, host.size());
    crowd.run(host.size(), bins, particles, cell_size, box, crowds);

    cellist::Neighbours found;
    for (int step = 0; step < 3; ++step) {
        bins.build(bin, host.size(), particles, cell_size);
        found = bins.neighbours(
            {.distance = "cellist_norm(cellist_minimum_image((float3)("
                         "record.x - other.x, record.y - other.y, record.z - other.z), box.xyz))",
             .radius = cell_size,
             .values = {{"box", cl_float4{{box, box, box, 0}}}}},
            std::move(found));
    }

    cellist::Packed<Particle> sorted = bins.pack();
    cellist::Kernel sums(device, source, "sums", cellist::type<Particle>);
    cellist::Buffer<cl_uint> sums_of_ids(device, found.records);
    sums.run(found.records, found.offsets, found.indices, sorted.records, sums_of_ids);

    const std::vector<cl_uint> expected = crowds.download();
    const std::vector<cl_uint> offsets = found.offsets.download();
    const std::vector<Particle> places = sorted.records.download();
    bool same = found.records == host.size() && !sums_of_ids.download().empty();
    for (std::size_t i = 0; i < places.size(); ++i)
        same = same && offsets[i + 1] - offsets[i] == expected[places[i].id];
    check(same, "the rows have as many neighbours as the kernel finds");

    cellist::Buffer<cl_float4> queries(
        device, std::vector<cl_float4>{{{0.5F, 0.5F, 0.5F, 0}}, {{0, 0, 0, 0}}});
    cellist::Nearest<Particle> nearest = bins.nearest(
        queries, {.k = 16,
                  .position = "query.xyz / size",
                  .distance = "cellist_norm(cellist_minimum_image((float3)(record.x - query.x, "
                              "record.y - query.y, record.z - query.z), (float3)(1.0f)))",
                  .radius = cell_size,
                  .values = {{"size", cell_size}}});
    std::vector<cl_uint> counts = nearest.counts.download();
    std::vector<Particle> records = nearest.records.download();  // 16 elements for each query

    const std::vector<cl_float> distances = nearest.distances.download();
    check(counts.size() == 2 && counts[0] > 2 && records.size() == 32, "queries find particles");
    check(std::is_sorted(distances.begin(), distances.begin() + counts[0]), "in order");
}
