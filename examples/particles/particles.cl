// SPDX-License-Identifier: MIT
// Neighbour search with cell lists: every particle goes to the list of its cell, and its neighbours
// are looked for in the lists of the cells around it.
//
// All axes of the container are periodic. Space is divided into cells without end, and cell (x, y,
// z) shares the list (x mod extent, y mod extent, z mod extent) with others, so that the memory
// depends on the number of particles and not on where they are: one particle far away costs one
// node. What shares a list in this way alone is told apart by its distance. In a periodic box, the
// box is a whole number of cells wide.
#include <cellist/lists.clh>

// Products that are added are explicit fma: host and device get the same bits.
#pragma OPENCL FP_CONTRACT OFF

// The coordinate inside of a periodic box. Open space has an infinite period.
static float wrap(float x, float period) {
    if (isinf(period) || (x >= 0.0f && x < period)) return x;
    const float rest = fmod(x, period);
    const float inside = rest < 0.0f ? rest + period : rest;
    return inside < period ? inside : 0.0f;
}

// The cell of a coordinate. The product's rounding error is taken into account: far from the
// origin, it may be several cells. What lies beyond 2^30 cells counts as being there, so that an
// int holds every cell; this brings no two places further apart.
static int cell_of(float x, float cells_per_unit) {
    const float place = x * cells_per_unit;
    if (fabs(place) >= 0x1p30f) return place < 0.0f ? -(1 << 30) : 1 << 30;
    const float error = fma(x, cells_per_unit, -place);
    const float whole = floor(place);
    return (int)whole + (int)floor(place - whole + error);
}

// One work-item a point. Points without a place in space are rejected.
kernel void insert_particles(CELLIST_LISTS(Particle, particles), global const Particle* points,
                             uint count, float period, float cells_per_unit) {
    const uint i = get_global_id(0);
    if (i >= count) return;
    const Particle point = points[i];
    const int valid = isfinite(point.x) && isfinite(point.y) && isfinite(point.z);
    const Particle particle = {wrap(point.x, period), wrap(point.y, period), wrap(point.z, period),
                               point.id};
    const uint cell = valid ? cellist_cell3(particles, cell_of(particle.x, cells_per_unit),
                                            cell_of(particle.y, cells_per_unit),
                                            cell_of(particle.z, cells_per_unit))
                            : CELLIST_NONE;
    cellist_insert(particles, cell, particle);
}

// The finalizer of MurmurHash3.
static uint hash(uint x) {
    x = (x ^ (x >> 16)) * 0x85EBCA6Bu;
    x = (x ^ (x >> 13)) * 0xC2B2AE35u;
    return x ^ (x >> 16);
}

// For each particle, the number of its neighbours, and the sum of hashes of their numbers, which
// does not depend on their order. One work-item a particle.
//
// offsets      where the neighbours of each particle begin, and the end of the last
// neighbours   numbers of points
kernel void sum_neighbours(global const uint* offsets, global const uint* neighbours, uint count,
                           global uint2* found) {
    const uint i = get_global_id(0);
    if (i >= count) return;
    uint sum = 0;
    for (uint n = offsets[i]; n < offsets[i + 1]; ++n) sum += hash(neighbours[n]);
    found[i] = (uint2)(offsets[i + 1] - offsets[i], sum);
}
