// SPDX-License-Identifier: MIT
#include "grid/triangle_grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <glm/common.hpp>

#include "grid_kernels.hpp"
#include "input_error.hpp"

namespace grid {
namespace {

/// At most as many triangles at each end of an axis may lie outside of the grid.
constexpr std::size_t outliers_max = 32;

/// Kernels number corners in 32 bits.
constexpr std::size_t triangles_max = 0xFFFFFFFF / 3;

/// Large triangles are shared out while there is room for these parts.
constexpr std::size_t parts_max = 65536;

bool is_finite(const GridTriangle& triangle) {
    for (const glm::vec3& corner : {triangle.a, triangle.b, triangle.c})
        for (int k = 0; k < 3; ++k)
            if (!std::isfinite(corner[k])) return false;
    return true;
}

std::span<const GridTriangle> numbered(std::span<const GridTriangle> triangles) {
    if (triangles.size() > triangles_max)
        throw cellist::Error("a grid of " + std::to_string(triangles.size()) +
                             " triangles: expected at most " + std::to_string(triangles_max));
    return triangles;
}

/// How many cubes of 2^bits cells along each axis the grid has.
std::uint64_t cubes_of(const GridCells& cells, int bits) {
    std::uint64_t cubes = 1;
    for (const cl_int extent : cells.extent)
        cubes *= (static_cast<std::uint64_t>(extent) + (1U << bits) - 1) >> bits;
    return cubes;
}

/// Cells along the longest side of a box for so many triangles: a constant number of cells per
/// triangle (Wald, Ize, Kensler, Knoll, Parker: "Ray Tracing Animated Scenes using Coherent Grid
/// Traversal", SIGGRAPH 2006). A flat box counts as a slab.
int suitable_longest(const glm::dvec3& size, std::size_t triangles) {
    constexpr double cells_per_triangle = 32;
    const double longest = std::max({size.x, size.y, size.z});
    if (!(longest > 0)) return 1;
    const glm::dvec3 sides = glm::max(size / longest, glm::dvec3(1.0 / 64));
    const double volume = sides.x * sides.y * sides.z;
    const double cells = std::cbrt(cells_per_triangle * static_cast<double>(triangles) / volume);
    return static_cast<int>(std::clamp(cells, 4.0, double{GRID_EXTENT_MAX}));
}

/// The ends of the triangles along an axis, without the outliers.
struct Ends {
    double low = std::numeric_limits<double>::infinity();
    double high = -std::numeric_limits<double>::infinity();
};

Ends ends_along(std::vector<float>& lows, std::vector<float>& highs) {
    if (lows.empty()) return {0, 0};
    const auto at = [](std::vector<float>& values, std::size_t rank) -> double {
        std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(rank),
                         values.end());
        return static_cast<double>(values[rank]);
    };
    const std::size_t count = lows.size();
    // A thousandth, so that small meshes are not cut.
    const std::size_t left_out = std::min(outliers_max, count / 1000);
    const Ends all{at(lows, 0), at(highs, count - 1)};
    const Ends most{at(lows, left_out), at(highs, count - 1 - left_out)};
    return all.high - all.low > 2 * (most.high - most.low) ? most : all;
}

std::string join(std::initializer_list<std::string_view> parts) {
    std::string text;
    for (const std::string_view part : parts) text.append(part).append("\n");
    return text;
}

constexpr std::string_view includes = "#include <cellist/lists.clh>\n#include <cellist/glm.clh>\n";

}  // namespace

GridCells cells_around(std::span<const GridTriangle> triangles, int longest) {
    glm::dvec3 low(0), high(0);
    std::size_t count = 0;
    for (int k = 0; k < 3; ++k) {
        std::vector<float> lows, highs;
        lows.reserve(triangles.size());
        highs.reserve(triangles.size());
        for (const GridTriangle& triangle : triangles) {
            if (!is_finite(triangle)) continue;
            const auto [least, most] = std::minmax({triangle.a[k], triangle.b[k], triangle.c[k]});
            lows.push_back(least);
            highs.push_back(most);
        }
        count = lows.size();
        const Ends ends = ends_along(lows, highs);
        low[k] = ends.low;
        high[k] = ends.high;
    }
    return cells_in_box(low, high, longest, count);
}

GridCells cells_in_box(const glm::dvec3& low, const glm::dvec3& high, int longest,
                       std::size_t triangles) {
    if (longest < 0 || longest > GRID_EXTENT_MAX)
        throw support::InputError("a grid of " + std::to_string(longest) +
                                  " cells: expected 1 to " + std::to_string(GRID_EXTENT_MAX));
    const glm::dvec3 size = high - low;
    constexpr auto largest = static_cast<double>(std::numeric_limits<float>::max());
    for (int k = 0; k < 3; ++k)
        if (!(low[k] <= high[k] && low[k] >= -largest && high[k] <= largest))
            throw support::InputError("the box of a grid reaches from " + std::to_string(low[k]) +
                                      " to " + std::to_string(high[k]) +
                                      ": expected finite ends in rising order");
    if (longest == 0) longest = suitable_longest(size, triangles);
    const double side = std::max({size.x, size.y, size.z});
    const glm::dvec3 farthest = glm::max(glm::abs(low), glm::abs(high));
    // Scales coordinates to 1 or less, except those beyond 2^126.
    const double reach = std::max({farthest.x, farthest.y, farthest.z});
    const int exponent = reach > 0 ? std::clamp(std::ilogb(reach) + 1, -126, 126) : 0;
    // A single point still has a cell around it, and its inverse is a float.
    const double cell = side > 0 ? std::max(side / longest, std::ldexp(1.0, exponent - 100))
                                 : std::max(reach, std::ldexp(1.0, exponent));

    GridCells cells{};
    cells.unit = static_cast<cl_float>(std::ldexp(1.0, -exponent));
    cells.cells_per_unit = static_cast<cl_float>(std::ldexp(1 / cell, exponent));
    for (int k = 0; k < 3; ++k) {
        cells.origin[k] = static_cast<cl_float>(low[k]);
        cells.extent[k] = std::clamp(static_cast<cl_int>(std::ceil(size[k] / cell)), 1, longest);
    }
    return cells;
}

cellist::Range whole_device(const cellist::DeviceInfo& device) {
    const std::size_t group = device.one_thread_per_work_group ? 1 : 64;
    const std::size_t groups =
        std::size_t{device.compute_units} * (device.one_thread_per_work_group ? 1 : 16);
    return cellist::Range::padded(groups * group, group);
}

double cell_side(const GridCells& cells) {
    return 1 / (static_cast<double>(cells.cells_per_unit) * static_cast<double>(cells.unit));
}

TriangleGrid::TriangleGrid(const cellist::Device& device, std::span<const GridTriangle> triangles,
                           const GridCells& cells, cellist::Storage storage)
    : cells_(cells),
      bricks_(cubes_of(cells, GRID_BRICK_BITS)),
      triangles_(device, numbered(triangles)),
      corners_(device, 3 * triangles.size()),
      occupancy_(device, bricks_ + bricks_ / sizeof(cl_ulong) + 1),
      parts_range_(whole_device(device.info())),
      parts_(device, parts_max),
      part_count_(device, 1),
      entries_(device, {bricks_ * GRID_BRICK_CELLS + 1}, {.storage = storage}),
      insert_(kernel(device, "grid_insert")),
      insert_parts_(kernel(device, "grid_insert_parts")),
      find_occupied_(kernel(device, "grid_find_occupied")),
      find_empty_(kernel(device, "grid_find_empty")) {
    occupancy_.fill(0);
}

cellist::Kernel TriangleGrid::kernel(const cellist::Device& device, const char* name) const {
    return {device,
            cellist::Source{.text = with_queries(kernels::insert_cl), .file_name = "insert.cl"},
            name,
            entries_,
            cellist::type<GridCells>,
            cellist::type<GridTriangle>,
            cellist::type<GridPart>};
}

cellist::BuildReport TriangleGrid::build() {
    const auto count = static_cast<cl_uint>(triangles_.size());
    const auto room = static_cast<cl_uint>(parts_.size());
    const cellist::BuildReport report = entries_.build([&] {
        part_count_.fill(0);
        insert_.run(cellist::Range::padded(count, 64), entries_, cells_, triangles_, count,
                    corners_, parts_, room, part_count_);
        insert_parts_.run(parts_range_, entries_, cells_, triangles_, parts_, room, part_count_);
    });
    find_occupied_.run(cellist::Range::padded(bricks_, 64), entries_, static_cast<cl_uint>(bricks_),
                       occupancy_);
    find_empty_.run(cellist::Range::padded(cubes_of(cells_, GRID_BLOCK_BITS), 64), cells_,
                    occupancy_);
    return report;
}

std::uint64_t TriangleGrid::device_bytes() const {
    return entries_.pool_bytes() + triangles_.size() * sizeof(GridTriangle) +
           corners_.size() * sizeof(cl_float4) + occupancy_.size() * sizeof(cl_ulong) +
           parts_.size() * sizeof(GridPart);
}

std::string with_queries(std::string_view source) {
    return join({includes, kernels::cells_h, kernels::segment_clh, kernels::walk_clh,
                 kernels::query_clh, source});
}

}  // namespace grid
