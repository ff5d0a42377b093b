// SPDX-License-Identifier: MIT
// The program of docs/mpi.md: particles in a periodic box, over any number of ranks.
#include <cstdio>
#include <cstdlib>
#include <vector>

#include <cellist/mpi.hpp>

#include "check.hpp"

struct Particle {
    cl_float x, y, z;
    cl_uint id;
};
CELLIST_STRUCT(Particle, x, y, z, id);

constexpr auto source = R"(
#include <cellist/lists.clh>
kernel void bin(CELLIST_LISTS(Particle, bins), global const Particle* particles, uint count)
{
    uint i = get_global_id(0);
    if (i >= count) return;
    Particle p = particles[i];
    cellist_insert(bins, cellist_cell3(bins, p.x, p.y, p.z), p);
}

// The number of other particles within 1 of each particle. One work-item a cell of the block.
kernel void crowd(CELLIST_LISTS(Particle, bins), uint4 origin, float3 box, global uint* pairs)
{
    uint x = get_global_id(0) + origin.x, y = get_global_id(1) + origin.y;
    uint z = get_global_id(2) + origin.z;
    uint found = 0;
    cellist_for_each(bins, cellist_cell3(bins, x, y, z), node) {
        Particle p = cellist_get(bins, node);
        cellist_for_each_around(bins, cellist_position3(x, y, z), 1, near) {
            Particle other = cellist_get(bins, near);
            float3 apart = cellist_minimum_image(
                (float3)(p.x - other.x, p.y - other.y, p.z - other.z), box);
            if (other.id != p.id && cellist_norm(apart) <= 1.0f) ++found;
        }
    }
    atomic_add(pairs, found);
}
)";

void run() {
    // Each rank makes a part of 4,000 particles, anywhere in a box of 8 x 8 x 8 cells.
    int rank = 0, ranks = 1;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    std::vector<Particle> mine;
    for (cl_uint id = 0; id < 4000; ++id) {
        const auto part = [&](cl_uint step) {
            return static_cast<float>(id * step % 4096) / 512.0f;
        };
        if (static_cast<int>(id) % ranks == rank)
            mine.push_back({part(1171), part(2333), part(3571), id});
    }

    const cellist::Device device = cellist::mpi::choose(MPI_COMM_WORLD);
    const cellist::mpi::Partition partition(MPI_COMM_WORLD, cellist::Shape{8, 8, 8},
                                            {.ghosts = 1, .periodic = {true, true, true}});
    cellist::mpi::Lists<Particle> bins(device, partition);
    cellist::Kernel bin(device, source, "bin", bins);

    cellist::Kernel crowd(device, source, "crowd", bins);

    const cellist::mpi::Block& block = partition.block();
    const cellist::Range cells(block.extent[0], block.extent[1], block.extent[2]);
    const cl_uint4 origin{{static_cast<cl_uint>(block.origin[0]),
                           static_cast<cl_uint>(block.origin[1]),
                           static_cast<cl_uint>(block.origin[2]), 0}};
    cellist::Buffer<cl_uint> pairs(device, 1);
    cl_uint all_pairs = 0;

    cellist::Buffer<Particle> particles(device, mine);
    for (int step = 0; step < 2; ++step) {
        const auto count = static_cast<cl_uint>(particles.size());
        const cellist::BuildReport report =
            bins.build(bin, cellist::Range(count), particles, count);
        check(report.stored == 4000, "report.stored == 4000");

        // The particles of this rank's block, for the next step.
        particles = bins.local().pack().records;
        bins.exchange_ghosts();
        pairs.fill(0);
        crowd.run(cells, bins, origin, cl_float3{{8, 8, 8, 0}}, pairs);
        cl_uint found = pairs.download()[0];
        MPI_Allreduce(MPI_IN_PLACE, &found, 1, MPI_UINT32_T, MPI_SUM, MPI_COMM_WORLD);
        // Each pair counts twice. No particle moves here, so the second step finds the same.
        check(found % 2 == 0 && found > 0, "found % 2 == 0 && found > 0");
        check(step == 0 || found == all_pairs, "step == 0 || found == all_pairs");
        all_pairs = found;
    }

    check(bins.lengths().total == 4000, "bins.lengths().total == 4000");
    // The same lists for any number of ranks.
    bins.sort(&Particle::id);
    const cellist::HostLists<Particle> lists = bins.download();
    check(lists.records().size() == 4000, "lists.records().size() == 4000");
    if (rank == 0) std::printf("%u pairs on %d ranks\n", all_pairs / 2, ranks);
}

int main(int argc, char** argv) {
    int level = 0;
    MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &level);
    try {
        run();
    } catch (const cellist::Error& error) {
        std::fprintf(stderr, "%s\n", error.what());
        MPI_Abort(MPI_COMM_WORLD, 1);
    }
    MPI_Finalize();
}
