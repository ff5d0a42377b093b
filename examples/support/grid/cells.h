// SPDX-License-Identifier: MIT
// Limits of the grid that the host and the device must agree on. Compiled as C++ and as OpenCL C.
#ifndef GRID_CELLS_H
#define GRID_CELLS_H

// Cells along each axis, at most.
#define GRID_EXTENT_MAX 1024

// A brick has 4 x 4 x 4 cells, and their lists follow one another: cell x, y, z of a brick has the
// index x + 4 y + 16 z in it.
#define GRID_BRICK_BITS 2
#define GRID_BRICK_CELLS 64

// A block has 4 x 4 x 4 bricks.
#define GRID_BLOCK_BITS 4

// How far a segment may leave the grid and still count as inside, in cells.
#define GRID_CLIP_ERROR 0x1p-9f

// A triangle may reach this far out of the grid, in cells, without being in the list of those that
// do. Smaller than GRID_CLIP_ERROR, so that clipping cannot lose a place on it.
#define GRID_OUTSIDE_ERROR 0x1p-10f

// Triangles are in the list of every cell that they come closer to than this along every axis, in
// cells. Clipping moves a segment by up to 2^-9 + 2^-12, its roundings before that by less than
// 2^-10, and those of the walk by less than 2^-10.
#define GRID_MARGIN 0x1p-8f

// Corners beyond this, in units of the grid, are left to exact tests. Closer ones cannot overflow
// in a test in float.
#define GRID_CORNER_MAX 0x1p16f

// Segments whose ends are at most as far from the corner of the grid, in cells, are clipped in
// float.
#define GRID_NEAR 2048.0f

// A triangle that may touch more columns of cells is shared out over work-groups, in parts.
#define GRID_COLUMNS_ALONE 16u
#define GRID_COLUMNS_PER_PART 64u
#define GRID_PARTS_MAX 256u

#endif
