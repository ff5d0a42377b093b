// Neighbour search with cell lists: every particle goes to the list of its cell, and its neighbours
// are looked for in the lists of the cells around it.
//
// The cells are folded. Space is divided into cells without end, and cell (x, y, z) shares the list
// (x mod extent, y mod extent, z mod extent) with others, so that the memory depends on the number
// of particles and not on where they are: one particle far away costs one node. What shares a list
// by folding alone is told apart by its distance. Neighbouring cells stay neighbours, and up to
// `extent` cells in a row have lists of their own, so no list is visited twice.
//
// In a periodic box, the box is a whole number of cells wide, and folding is what makes it
// periodic.
//
// The lists are then packed: particles in the order of cells, which is what makes the search fast.
//
// points     a particle each: x, y, z
// offsets    where the list of each cell starts in `sorted`, and the end of the last
// sorted     the particles, cell by cell
// found      a point each: the number of its neighbours, and the sum of hashes of their numbers,
//            which does not depend on their order; 0 where the point was rejected
#include <cellist/lists.clh>

// Products that are added are explicit fma: host and device get the same bits.
#pragma OPENCL FP_CONTRACT OFF

// ---- distance --------------------------------------------------------------------------------

// The coordinate inside of a periodic box. Open space has an infinite period.
static float wrap(float x, float period) {
    if (isinf(period) || (x >= 0.0f && x < period)) return x;
    const float rest = fmod(x, period);
    const float inside = rest < 0.0f ? rest + period : rest;
    return inside < period ? inside : 0.0f;
}

// The distance of two coordinates, the short way round in a periodic box.
static float apart(float a, float b, float period) {
    const float straight = fabs(a - b);
    const float round = period - straight;
    return round < straight ? round : straight;
}

// 1 or 0.
static uint are_neighbours(Particle a, Particle b, Space space) {
    const float x = apart(a.x, b.x, space.period);
    const float y = apart(a.y, b.y, space.period);
    const float z = apart(a.z, b.z, space.period);
    return fma(x, x, fma(y, y, z * z)) <= space.radius * space.radius;
}

// ---- cells -----------------------------------------------------------------------------------

// The list that a cell shares with those `extent` cells away.
static int fold(int cell, int extent) {
    const int rest = cell % extent;
    return rest < 0 ? rest + extent : rest;
}

// A coordinate in cells. What lies beyond 2^30 cells counts as being there, so that an int holds
// every cell; like rounding, this brings no two places further apart.
static float place_of(float x, Space space) {
    return clamp(x * space.cells_per_unit, -0x1p30f, 0x1p30f);
}

static int list_of(float x, Space space) {
    const int cell = (int)floor(place_of(x, space));
    // The last float under the period may be rounded up to it.
    return fold(isinf(space.period) ? cell : min(cell, space.extent - 1), space.extent);
}

// The cells along one axis that neighbours of a particle can be in.
typedef struct {
    float middle;  // the particle's place, in cells
    float slack;   // more than what rounding moves a particle and its neighbour by, in cells
    int first;     // cells, not folded
    int count;     // at most the extent: then every list is visited once
    int whole;     // whether there would be more
} Around;

// A neighbour lies within `reach` cells. Places are rounded, by less than 2^-22 of themselves, the
// particle's and its neighbour's alike; the slack is more than both, so that no neighbour is missed
// wherever it is. Where floats are so coarse that the slack spans cells, more cells are visited.
static Around cells_around(float x, float reach, Space space) {
    Around around;
    around.middle = place_of(x, space);
    around.slack = fma(fabs(around.middle), 0x1p-20f, 0x1p-12f);
    around.first = (int)floor(around.middle - reach - around.slack);
    const int last = (int)floor(around.middle + reach + around.slack);
    const int count = last - around.first + 1;
    around.whole = count > space.extent;
    around.count = min(count, space.extent);
    return around;
}

// The square of the distance between the particle and its i-th cell along this axis, or less.
static float gap_squared(Around around, int i) {
    if (around.whole) return 0.0f;
    const float cell = (float)(around.first + i);
    const float gap = fmax(cell - around.middle, around.middle - cell - 1.0f) - around.slack;
    return gap > 0.0f ? gap * gap : 0.0f;
}

// ---- kernels ---------------------------------------------------------------------------------

// One work-item a particle. Particles without a place in space are rejected.
kernel void insert_particles(CELLIST_LISTS(Particle, particles), global const float4* points,
                             uint count, const Space space) {
    const uint i = get_global_id(0);
    if (i >= count) return;
    const float4 point = points[i];
    const int valid = isfinite(point.x) && isfinite(point.y) && isfinite(point.z);
    const Particle particle = {wrap(point.x, space.period), wrap(point.y, space.period),
                               wrap(point.z, space.period), i};
    const uint cell = valid ? cellist_cell3(particles, list_of(particle.x, space),
                                            list_of(particle.y, space), list_of(particle.z, space))
                            : CELLIST_NONE;
    cellist_insert(particles, cell, particle);
}

// The finalizer of MurmurHash3.
static uint hash(uint x) {
    x = (x ^ (x >> 16)) * 0x85EBCA6Bu;
    x = (x ^ (x >> 13)) * 0xC2B2AE35u;
    return x ^ (x >> 16);
}

// The neighbours of a particle from `begin` up to `end`: how many, and the sum of their hashes.
static uint2 neighbours_among(global const Particle* sorted, uint begin, uint end, Particle me,
                              Space space) {
    uint count = 0;
    uint sum = 0;
    for (uint n = begin; n < end; ++n) {
        const Particle it = sorted[n];
        // No branch: half of the candidates are neighbours, which no processor can predict.
        const uint is = are_neighbours(me, it, space) & (uint)(it.id != me.id);
        count += is;
        sum += hash(it.id) & -is;
    }
    return (uint2)(count, sum);
}

// One work-item a particle, in the order of cells, so that work-items look at the same lists at the
// same time. The lists of cells that follow one another along x are one piece of `sorted`.
kernel void find_neighbours(global const uint* offsets, global const Particle* sorted, uint count,
                            const Space space, global uint2* found) {
    const uint i = get_global_id(0);
    if (i >= count) return;
    const Particle me = sorted[i];
    const int extent = space.extent;
    const Around ys = cells_around(me.y, space.reach, space);
    const Around zs = cells_around(me.z, space.reach, space);
    uint2 mine = (uint2)(0, 0);
    for (int z = 0; z < zs.count; ++z) {
        for (int y = 0; y < ys.count; ++y) {
            const float rest = space.reach * space.reach - gap_squared(zs, z) - gap_squared(ys, y);
            if (rest < 0.0f) continue;
            // A row of cells, in two pieces where folding parts it.
            const Around xs = cells_around(me.x, sqrt(rest), space);
            const int row =
                (fold(zs.first + z, extent) * extent + fold(ys.first + y, extent)) * extent;
            const int begin = fold(xs.first, extent);
            const int end = begin + xs.count;
            mine += neighbours_among(sorted, offsets[row + begin], offsets[row + min(end, extent)],
                                     me, space);
            if (end > extent)
                mine +=
                    neighbours_among(sorted, offsets[row], offsets[row + end - extent], me, space);
        }
    }
    found[me.id] = mine;
}
