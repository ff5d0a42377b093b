// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include <cellist/mpi.hpp>

namespace bench {

/// A record of the size of a particle, 16 bytes.
struct MpiRecord {
    cl_uint number, hash, b, c;
};
CELLIST_STRUCT(MpiRecord, number, hash, b, c);

/// The records of one rank. Their cells are computed by bench_mpi_cell in input.h.
struct MpiInput {
    cl_uint kind = {};       ///< MPI_RANDOM, MPI_COHERENT or MPI_PARTICLES
    cl_uint first = {};      ///< the number of the first record
    cl_uint count = {};      ///< of records
    cl_uint extent[3] = {};  ///< of all cells
    cl_uint origin[3] = {};  ///< of the rank's block
    cl_uint own[3] = {};     ///< extents of the rank's block
    cl_uint step[3] = {};    ///< from a block to the next, in cells
};
CELLIST_STRUCT(MpiInput, kind, first, count, extent, origin, own, step);

}  // namespace bench
