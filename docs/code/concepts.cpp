// SPDX-License-Identifier: MIT
#include <cellist/cellist.hpp>

#include "check.hpp"

struct Particle {
    cl_float x, y, z;
    cl_uint id;
};
CELLIST_STRUCT(Particle, x, y, z, id);

constexpr auto bin_source = R"(
#include <cellist/lists.clh>

kernel void bin(CELLIST_LISTS(Particle, bins), global const Particle* particles, float cell_size)
{
    Particle p = particles[get_global_id(0)];
    uint cell = cellist_cell3(bins, p.x / cell_size, p.y / cell_size, p.z / cell_size);
    cellist_insert(bins, cell, p);
}
)";

constexpr auto lowest_source = R"(
#include <cellist/lists.clh>

kernel void lowest(CELLIST_LISTS(Particle, bins), global float* lowest)
{
    uint cell = get_global_id(0);
    lowest[cell] = INFINITY;
    cellist_for_each(bins, cell, node)
        lowest[cell] = fmin(lowest[cell], cellist_get(bins, node).y);
}
)";

constexpr auto nearest_source = R"(
#include <cellist/lists.clh>

// The distance from each particle to its nearest neighbour, or cell_size if there is none nearer.
kernel void nearest(CELLIST_LISTS(Particle, bins), global const Particle* particles, float cell_size,
                    global float* distances)
{
    Particle p = particles[get_global_id(0)];
    uint cell = cellist_cell3(bins, p.x / cell_size, p.y / cell_size, p.z / cell_size);
    float least = cell_size;
    cellist_for_each_around(bins, cell, 1, node) {
        Particle other = cellist_get(bins, node);
        if (other.id != p.id)
            least = fmin(least, distance((float3)(p.x, p.y, p.z),
                                         (float3)(other.x, other.y, other.z)));
    }
    distances[get_global_id(0)] = least;
}
)";

int main() {
    std::vector<Particle> host(100'000);
    for (cl_uint i = 0; i < host.size(); ++i)
        host[i] = {float(i % 97) + 0.5f, float(i % 89) + 0.5f, float(i % 83) + 0.5f, i};

    cellist::Device device = cellist::Device::choose();
    cellist::Buffer<Particle> particles(device, host);

    cellist::Lists<Particle> bins(device, {16, 16, 16});
    cellist::Kernel bin(device, bin_source, "bin", bins);
    bins.build(bin, particles.size(), particles, 4.0f);

    cellist::Buffer<cl_float> heights(device, bins.shape().cells());
    cellist::Kernel lowest(device, lowest_source, "lowest", bins);
    lowest.run(bins.shape().cells(), bins, heights);
    std::vector<cl_float> result = heights.download();

    cellist::Lengths lengths = bins.lengths();
    std::cout << lengths.nonempty_cells << " bins, the fullest with " << lengths.longest << '\n';

    check(result[0] == 0.5f, "the lowest particle of the first bin");
    check(lengths.total == bins.download().records().size(), "the number of binned particles");

    device.prepare(
        [&] {
            bins.build(bin, particles.size(), particles, 4.0f);
            lowest.run(bins.shape().cells(), bins, heights);
            bins.sort(&Particle::y);
        },
        [](std::size_t programs) { std::cout << programs << " programs are ready\n"; });
    check(heights.download() == result, "the lowest particles again");

    // Two particles in neighbouring cells, and two at one position.
    cellist::Buffer<Particle> few(
        device, std::vector<Particle>{{1, 1, 1, 0}, {1, 1, 4, 1}, {9, 9, 9, 2}, {9, 9, 9, 3}});
    bins.build(bin, few.size(), few, 4.0f);
    cellist::Buffer<cl_float> distances(device, few.size());
    cellist::Kernel nearest(device, nearest_source, "nearest", bins);
    nearest.run(few.size(), bins, few, 4.0f, distances);
    check(distances.download() == std::vector<cl_float>{3, 3, 0, 0}, "the nearest neighbours");

    // Particles outside the grid are counted but never stored.
    cellist::BuildReport report = bins.build(bin, particles.size(), particles, 1.0f);
    std::cout << report.stored << " of " << report.attempted << " particles lie in the grid, "
              << report.rejected << " outside\n";
    check(report.rejected > 0 && report.attempted == host.size(), "the report");

    // Sort by distance from the origin; order equal distances by x, y, z, id.
    bins.sort_by("record.x * record.x + record.y * record.y + record.z * record.z");
    auto sorted = bins.download();
    for (std::uint64_t cell = 0; cell < sorted.cells(); ++cell) {
        float last = 0;
        for (const Particle& p : sorted.cell(cell)) {
            const float square = p.x * p.x + p.y * p.y + p.z * p.z;
            check(square >= last, "the order of distances");
            last = square;
        }
    }
    check(bins.validate().ok(), "the lists are sound");
}
