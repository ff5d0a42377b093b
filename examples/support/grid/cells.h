// Limits of the grid that the host and the device must agree on. Compiled as C++ and as OpenCL C.
#ifndef GRID_CELLS_H
#define GRID_CELLS_H

// Cells along each axis, at most.
#define GRID_EXTENT_MAX 1024

// How far a walk may be off its segment, in cells: 8 roundings of coordinates of up to
// GRID_EXTENT_MAX cells come to 2^-11.
#define GRID_WALK_ERROR 0.001953125f

// Triangles are in the list of every cell that they come closer to than this, in cells: the errors
// of the walk and of the triangle's own coordinates.
#define GRID_MARGIN 0.00390625f

#endif
