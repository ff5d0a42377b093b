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

// Triangles are in the list of every cell that they come closer to than this, in cells. Clipping
// moves a segment by up to 2^-9, and the roundings of the walk by less than 2^-10.
#define GRID_MARGIN 0x1p-8f

// Segments whose ends are at most as far from the corner of the grid, in cells, are clipped in
// float.
#define GRID_NEAR 2048.0f

// A triangle that may touch more columns of cells is shared out over work-items, in parts.
#define GRID_COLUMNS_PER_PART 64u
#define GRID_PARTS_MAX 256u

#endif
