#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include <cellist/cellist.hpp>
#include <cellist/glm.hpp>

#include "grid/cells.h"

namespace grid {

struct GridTriangle {
    glm::vec3 a, b, c;
};
CELLIST_STRUCT(GridTriangle, a, b, c);

/// A triangle in the list of a cell.
struct GridEntry {
    cl_uint triangle;
};
CELLIST_STRUCT(GridEntry, triangle);

/// The cells of a grid: cubes of the same size. Coordinates are multiplied by `unit` first, so that
/// very large and very small meshes stay in the range of floats.
struct GridCells {
    cl_float origin[3];
    cl_float unit;            ///< a power of 2
    cl_float cells_per_unit;  ///< of coordinates that were multiplied by `unit`
    cl_int extent[3];
};
CELLIST_STRUCT(GridCells, origin, unit, cells_per_unit, extent);

/// The side of a cell.
[[nodiscard]] double cell_side(const GridCells& cells);

/// Cells around the bounding box of the triangles, `longest` along its longest side. Triangles that
/// are not finite do not count. Throws InputError unless 1 <= longest <= GRID_EXTENT_MAX.
[[nodiscard]] GridCells cells_around(std::span<const GridTriangle> triangles, int longest);

/// Triangles in the cells of a 3D grid, for queries with segments (Yang, Hensley, Gruen, Thibieroz:
/// "Real-Time Concurrent Linked List Construction on the GPU", EGSR 2010, section 4.2).
///
/// Kernels use it through query.clh:
///
///     cellist::Kernel shade(device, grid::with_queries(source), "shade", triangles.entries(),
///                           cellist::type<grid::GridCells>, cellist::type<grid::GridTriangle>);
///     shade.run(range, triangles.entries(), triangles.cells(), triangles.triangles(), ...);
class TriangleGrid {
public:
    /// Uploads the triangles and builds the kernel. The grid is empty until build().
    TriangleGrid(const cellist::Device& device, std::span<const GridTriangle> triangles,
                 const GridCells& cells, cellist::Storage storage = cellist::Storage::counted);

    /// Puts every triangle into every cell that its bounding box touches. Blocks. Triangles that
    /// are not finite are counted as rejected.
    cellist::BuildReport build();

    [[nodiscard]] const cellist::Lists<GridEntry>& entries() const { return entries_; }
    [[nodiscard]] const GridCells& cells() const { return cells_; }
    [[nodiscard]] const cellist::Buffer<GridTriangle>& triangles() const { return triangles_; }

private:
    GridCells cells_;
    cellist::Buffer<GridTriangle> triangles_;
    cellist::Lists<GridEntry> entries_;
    cellist::Kernel insert_;
};

/// A kernel's source behind everything that query.clh defines.
[[nodiscard]] std::string with_queries(std::string_view source);

}  // namespace grid
