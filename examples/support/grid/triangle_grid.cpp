#include "grid/triangle_grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/common.hpp>

#include "grid_kernels.hpp"
#include "input_error.hpp"

namespace grid {
namespace {

bool is_finite(const GridTriangle& triangle) {
    for (const glm::vec3& corner : {triangle.a, triangle.b, triangle.c})
        for (int k = 0; k < 3; ++k)
            if (!std::isfinite(corner[k])) return false;
    return true;
}

cellist::Shape shape_of(const GridCells& cells) {
    const auto extent = [&](int k) { return static_cast<std::uint64_t>(cells.extent[k]); };
    return {extent(0), extent(1), extent(2)};
}

std::string join(std::initializer_list<std::string_view> parts) {
    std::string text;
    for (const std::string_view part : parts) text.append(part).append("\n");
    return text;
}

constexpr std::string_view includes = "#include <cellist/lists.clh>\n#include <cellist/glm.clh>\n";

}  // namespace

GridCells cells_around(std::span<const GridTriangle> triangles, int longest) {
    if (longest < 1 || longest > GRID_EXTENT_MAX)
        throw support::InputError("a grid of " + std::to_string(longest) +
                                  " cells: expected 1 to " + std::to_string(GRID_EXTENT_MAX));
    glm::dvec3 low(std::numeric_limits<double>::infinity());
    glm::dvec3 high = -low;
    for (const GridTriangle& triangle : triangles) {
        if (!is_finite(triangle)) continue;
        for (const glm::vec3& corner : {triangle.a, triangle.b, triangle.c}) {
            low = glm::min(low, glm::dvec3(corner));
            high = glm::max(high, glm::dvec3(corner));
        }
    }
    if (!(low.x <= high.x)) low = high = glm::dvec3(0);
    const glm::dvec3 size = high - low;
    const double side = std::max({size.x, size.y, size.z});
    const glm::dvec3 farthest = glm::max(glm::abs(low), glm::abs(high));
    // Scales coordinates to 1 or less, except those beyond 2^100.
    const double reach = std::max({farthest.x, farthest.y, farthest.z});
    const int exponent = reach > 0 ? std::clamp(std::ilogb(reach) + 1, -100, 100) : 0;
    // A single point still has a cell around it.
    const double cell = side > 0 ? side / longest : std::max(reach, std::ldexp(1.0, exponent));

    GridCells cells{};
    cells.unit = static_cast<cl_float>(std::ldexp(1.0, -exponent));
    cells.cells_per_unit = static_cast<cl_float>(std::ldexp(1 / cell, exponent));
    for (int k = 0; k < 3; ++k) {
        cells.origin[k] = static_cast<cl_float>(low[k]);
        cells.extent[k] = std::clamp(static_cast<cl_int>(std::ceil(size[k] / cell)), 1, longest);
    }
    return cells;
}

double cell_side(const GridCells& cells) {
    return 1 / (static_cast<double>(cells.cells_per_unit) * static_cast<double>(cells.unit));
}

TriangleGrid::TriangleGrid(const cellist::Device& device, std::span<const GridTriangle> triangles,
                           const GridCells& cells, cellist::Storage storage)
    : cells_(cells),
      triangles_(device, triangles),
      entries_(device, shape_of(cells), {.storage = storage}),
      insert_(device,
              cellist::Source{.text = join({includes, kernels::cells_h, kernels::insert_cl}),
                              .file_name = "insert.cl"},
              "grid_insert", entries_, cellist::type<GridCells>, cellist::type<GridTriangle>) {}

cellist::BuildReport TriangleGrid::build() {
    const auto count = static_cast<cl_uint>(triangles_.size());
    return entries_.build(insert_, cellist::Range::padded(count, 64), cells_, triangles_, count);
}

std::string with_queries(std::string_view source) {
    return join({includes, kernels::cells_h, kernels::segment_clh, kernels::walk_clh,
                 kernels::query_clh, source});
}

}  // namespace grid
