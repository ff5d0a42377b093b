// SPDX-License-Identifier: MIT
#include "reference/raster.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace oit {
namespace {

struct Corner {
    std::int64_t x, y;  // sub-pixels
    double w;
    std::array<double, 3> share;
};

// Twice the signed area of a, b, p.
std::int64_t cross(const Corner& a, const Corner& b, std::int64_t x, std::int64_t y) {
    return (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x);
}

bool is_top_or_left(const Corner& a, const Corner& b) {
    return b.y < a.y || (b.y == a.y && b.x > a.x);
}

// A triangle whose edge functions are positive inside.
struct Triangle {
    std::array<Corner, 3> corner;
    double area;
    bool front;

    // The edge functions at a place, in the order of the opposite corners.
    [[nodiscard]] std::array<std::int64_t, 3> edges(std::int64_t x, std::int64_t y) const {
        return {cross(corner[1], corner[2], x, y), cross(corner[2], corner[0], x, y),
                cross(corner[0], corner[1], x, y)};
    }
    [[nodiscard]] bool contains(const std::array<std::int64_t, 3>& edge) const {
        for (std::size_t i = 0; i < 3; ++i)
            if (edge[i] < 0 ||
                (edge[i] == 0 && !is_top_or_left(corner[(i + 1) % 3], corner[(i + 2) % 3])))
                return false;
        return true;
    }
    // The parts of the corners at a place, each over its depth; their sum is 1 / depth.
    [[nodiscard]] std::array<double, 3> parts(const std::array<double, 3>& edge) const {
        return {edge[0] / area / corner[0].w, edge[1] / area / corner[1].w,
                edge[2] / area / corner[2].w};
    }
};

double sum(const std::array<double, 3>& v) { return v[0] + v[1] + v[2]; }

// What the triangle covers of a pixel; no samples where it covers nothing.
ReferenceCover cover_of(const Triangle& triangle, int x, int y,
                        std::span<const raster::SampleOffset> offsets) {
    ReferenceCover cover{x, y, 0, 0, {}, {}, triangle.front};
    std::array<double, 3> mean{};
    int covered = 0;
    for (std::size_t s = 0; s < offsets.size(); ++s) {
        const auto at = [](int pixel, int offset) {
            return std::int64_t{pixel} * RASTER_SUBPIXELS + RASTER_SUBPIXELS / 2 +
                   RASTER_OFFSET_UNIT * offset;
        };
        const auto edge = triangle.edges(at(x, offsets[s].x), at(y, offsets[s].y));
        if (!triangle.contains(edge)) continue;
        cover.coverage |= 1U << s;
        ++covered;
        const std::array<double, 3> here{static_cast<double>(edge[0]), static_cast<double>(edge[1]),
                                         static_cast<double>(edge[2])};
        for (std::size_t i = 0; i < 3; ++i) mean[i] += here[i];
        cover.sample_depth[s] = 1 / sum(triangle.parts(here));
    }
    if (covered == 0) return cover;
    for (double& edge : mean) edge /= covered;
    const std::array<double, 3> part = triangle.parts(mean);
    cover.depth = 1 / sum(part);
    for (std::size_t j = 0; j < 3; ++j)
        for (std::size_t i = 0; i < 3; ++i)
            cover.weight[j] += part[i] * cover.depth * triangle.corner[i].share[j];
    return cover;
}

template <class Emit>
void scan(std::array<Corner, 3> c, const raster::View& view,
          std::span<const raster::SampleOffset> offsets, const Emit& emit) {
    const std::int64_t signed_area = cross(c[0], c[1], c[2].x, c[2].y);
    if (signed_area == 0) return;
    const bool front = signed_area < 0;
    if (front) std::swap(c[1], c[2]);
    const Triangle triangle{c, static_cast<double>(std::abs(signed_area)), front};
    const auto [x_low, x_high] = std::minmax({c[0].x, c[1].x, c[2].x});
    const auto [y_low, y_high] = std::minmax({c[0].y, c[1].y, c[2].y});
    const auto first = [](std::int64_t low) {
        return static_cast<int>(std::max<std::int64_t>(0, low / RASTER_SUBPIXELS - 1));
    };
    const auto last = [](std::int64_t high, int side) {
        return static_cast<int>(std::min<std::int64_t>(side - 1, high / RASTER_SUBPIXELS + 1));
    };
    for (int y = first(y_low); y <= last(y_high, view.height); ++y)
        for (int x = first(x_low); x <= last(x_high, view.width); ++x) {
            const ReferenceCover cover = cover_of(triangle, x, y, offsets);
            if (cover.coverage != 0) emit(cover);
        }
}

}  // namespace

void for_each_cover(
    const support::Mesh& mesh, const Projection<float>& projection, int samples,
    const std::function<void(std::size_t triangle, const ReferenceCover& cover)>& emit) {
    const raster::View& view = projection.view();
    const auto offsets = raster::sample_offsets(samples);
    const auto corner = [&](const Projection<float>::Vertex& v) {
        const auto snapped = [](float position, int side) {
            return static_cast<int>(std::rint(position)) + side * (RASTER_SUBPIXELS / 2);
        };
        const auto [x, y] = projection.position(v);
        return Corner{snapped(x, view.width),
                      snapped(y, view.height),
                      static_cast<double>(v.w),
                      {static_cast<double>(v.shares[0]), static_cast<double>(v.shares[1]),
                       static_cast<double>(v.shares[2])}};
    };
    for (std::size_t index = 0; index < mesh.triangles.size(); ++index) {
        const auto& [a, b, c] = mesh.triangles[index];
        const Projection<float>::Polygon polygon =
            projection.clipped({mesh.positions[a], mesh.positions[b], mesh.positions[c]});
        for (std::size_t i = 1; i + 1 < polygon.size(); ++i)
            scan({corner(polygon[0]), corner(polygon[i]), corner(polygon[i + 1])}, view, offsets,
                 [&](const ReferenceCover& cover) { emit(index, cover); });
    }
}

}  // namespace oit
