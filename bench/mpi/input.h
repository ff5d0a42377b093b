// SPDX-License-Identifier: MIT
// The cell of a record in the benchmark over MPI. Compiled as OpenCL C and as C++, after
// distribution.h and the definition of MpiInput.
#ifndef CELLIST_BENCH_MPI_INPUT_H
#define CELLIST_BENCH_MPI_INPUT_H

#ifdef __OPENCL_VERSION__
#define BENCH_BELOW(hash, n) mul_hi(hash, n)
#else
// A number below n from a hash.
#define BENCH_BELOW(hash, n) static_cast<bench_uint>((uint64_t{hash} * (n)) >> 32)
#endif

#define MPI_RANDOM 0u     // any cell of all
#define MPI_COHERENT 1u   // the rank's own cells, in order
#define MPI_PARTICLES 2u  // any of the rank's own cells; 5 % have moved to another block

// The index of the cell of a rank's i-th record.
BENCH_FUNCTION bench_uint bench_mpi_cell(const MpiInput input, bench_uint i) {
    const bench_uint hash = bench_hash(input.first + i);
    if (input.kind == MPI_RANDOM)
        return BENCH_BELOW(hash, input.extent[0] * input.extent[1] * input.extent[2]);
    const bench_uint own_cells = input.own[0] * input.own[1] * input.own[2];
    const bench_uint own =
        input.kind == MPI_COHERENT ? i % own_cells : BENCH_BELOW(hash, own_cells);
    bench_uint x = input.origin[0] + own % input.own[0];
    bench_uint y = input.origin[1] + own / input.own[0] % input.own[1];
    bench_uint z = input.origin[2] + own / (input.own[0] * input.own[1]);
    // Of 40 particles, about one has moved a block forwards, and one a block backwards.
    const bench_uint moved = BENCH_BELOW(bench_hash(hash), 40u);
    if (input.kind == MPI_PARTICLES && moved < 2u) {
        const bench_uint sign = 1u - 2u * moved;
        x = (x + input.extent[0] + sign * input.step[0]) % input.extent[0];
        y = (y + input.extent[1] + sign * input.step[1]) % input.extent[1];
        z = (z + input.extent[2] + sign * input.step[2]) % input.extent[2];
    }
    return (z * input.extent[1] + y) * input.extent[0] + x;
}

#endif
