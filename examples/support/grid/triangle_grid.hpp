// SPDX-License-Identifier: MIT
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

/// The cells of a grid: cubes of the same size. Coordinates are multiplied by `unit` first, so that
/// very large and very small meshes stay in the range of floats.
struct GridCells {
    cl_float origin[3];
    cl_float unit;            ///< a power of 2
    cl_float cells_per_unit;  ///< of coordinates that were multiplied by `unit`
    cl_int extent[3];
};
CELLIST_STRUCT(GridCells, origin, unit, cells_per_unit, extent);

/// A part of a large triangle, whose cells several work-groups share.
struct GridPart {
    cl_uint triangle, part, parts;
};
CELLIST_STRUCT(GridPart, triangle, part, parts);

/// The side of a cell.
[[nodiscard]] double cell_side(const GridCells& cells);

/// Cells around the bounding box of the triangles, `longest` along its longest side; for 0, 32
/// cells for each triangle. Triangles that are not finite do not count. Neither do outliers: up to
/// 32 triangles at each end of an axis, but no more than a thousandth, if the box is less than half
/// as long without them. Throws InputError unless 0 <= longest <= GRID_EXTENT_MAX.
[[nodiscard]] GridCells cells_around(std::span<const GridTriangle> triangles, int longest);

/// The same for a box that so many triangles move in. Throws InputError if its ends are not finite
/// or not in rising order.
[[nodiscard]] GridCells cells_in_box(const glm::dvec3& low, const glm::dvec3& high, int longest,
                                     std::size_t triangles);

/// Triangles in the cells of a 3D grid, for queries with segments (Yang, Hensley, Gruen, Thibieroz:
/// "Real-Time Concurrent Linked List Construction on the GPU", EGSR 2010, section 4.2). Triangles
/// may lie anywhere: those that reach out of the grid are in a list of their own, which slows down
/// segments that leave the grid.
///
/// rays.hpp traces many segments. Kernels can also use the grid themselves, through query.clh:
///
///     cellist::Kernel shade(device, grid::with_queries(source), "shade", triangles.entries(),
///                           cellist::type<grid::GridCells>, cellist::type<grid::GridTriangle>);
///     triangles.run(shade, range, ...);
class TriangleGrid {
public:
    /// Uploads the triangles and builds the kernels. The grid is empty until build(). Throws
    /// MemoryError if the device has no room for the cells, or Error for more than 2^32 / 3
    /// triangles.
    TriangleGrid(const cellist::Device& device, std::span<const GridTriangle> triangles,
                 const GridCells& cells, cellist::Storage storage = cellist::Storage::counted);

    /// Puts every triangle into the list of each cell that it overlaps. Blocks. Triangles that are
    /// not finite are counted as rejected. Kernels may write other triangles to triangles() before.
    cellist::BuildReport build();

    /// Enqueues a kernel whose first parameter is GRID_SCENE(name). Does not block.
    template <class... Args>
    cl::Event run(cellist::Kernel& kernel, const cellist::Range& range, const Args&... args) const {
        return kernel.run(range, entries_, cells_, triangles_, corners_, occupancy_, args...);
    }

    /// Device memory of the grid and the triangles.
    [[nodiscard]] std::uint64_t device_bytes() const;
    [[nodiscard]] const cellist::Lists<cl_uint>& entries() const { return entries_; }
    [[nodiscard]] const GridCells& cells() const { return cells_; }
    [[nodiscard]] const cellist::Buffer<GridTriangle>& triangles() const { return triangles_; }

private:
    [[nodiscard]] cellist::Kernel kernel(const cellist::Device& device, const char* name) const;

    GridCells cells_;
    std::uint64_t bricks_;
    cellist::Buffer<GridTriangle> triangles_;
    cellist::Buffer<cl_float4> corners_;
    cellist::Buffer<cl_ulong> occupancy_;
    cellist::Range parts_range_;
    cellist::Buffer<GridPart> parts_;
    cellist::Buffer<cl_uint> part_count_;
    cellist::Lists<cl_uint> entries_;
    cellist::Kernel insert_;
    cellist::Kernel insert_parts_;
    cellist::Kernel find_occupied_;
    cellist::Kernel find_empty_;
};

/// As many work-items as a device runs at once, in work-groups that share a task. On processors, a
/// work-group has one.
[[nodiscard]] cellist::Range whole_device(const cellist::DeviceInfo& device);

/// A kernel's source after everything that query.clh defines.
[[nodiscard]] std::string with_queries(std::string_view source);

}  // namespace grid
