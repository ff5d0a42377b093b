// SPDX-License-Identifier: MIT
#include "segments.hpp"

#include <algorithm>
#include <random>

namespace triangle_grid {
namespace {

class Generator {
public:
    Generator(const grid::GridCells& cells, std::span<const grid::GridTriangle> triangles,
              std::uint32_t seed)
        : cells_(cells), triangles_(triangles), random_(seed) {}

    Segment make(std::size_t kind) {
        Segment segment{anywhere(), anywhere()};
        const int axis = below(3);
        switch (kind) {
            case 1:
                segment.to = segment.from;
                segment.to[axis] = anywhere()[axis];
                break;
            case 2:
                segment.to[axis] = segment.from[axis] = face(axis);
                if (below(2) == 0) segment.to[(axis + 1) % 3] = segment.from[(axis + 1) % 3];
                break;
            case 3: {
                const int length = 1 + below(cells_.extent[axis]);
                for (int k = 0; k < 3; ++k) {
                    const int start = below(cells_.extent[k] + 1);
                    segment.from[k] = at_face(k, start);
                    segment.to[k] = at_face(k, start + (below(2) == 0 ? length : -length));
                }
                break;
            }
            case 4:
                segment.from = segment.to + 4.0F * (segment.from - segment.to);
                break;
            case 5:
                segment.from = segment.to + 1e6F * (segment.from - segment.to);
                break;
            case 6:
                segment.to = corner() * 2.0F - segment.from;
                break;
            case 7: {
                if (triangles_.empty()) break;
                const grid::GridTriangle& triangle = pick();
                segment = {triangle.a, triangle.b};
                // Longer than the edge, in its line as far as floats go.
                if (below(2) == 0) segment.to += segment.to - segment.from;
                break;
            }
            case 8:
                segment.to = segment.from = below(2) == 0 ? segment.from : corner();
                break;
            default:
                break;
        }
        return segment;
    }

private:
    int below(int limit) {
        return static_cast<int>(random_() % static_cast<std::uint32_t>(std::max(limit, 1)));
    }
    [[nodiscard]] float at_face(int k, int cell) const {
        return cells_.origin[k] + static_cast<float>(cell * grid::cell_side(cells_));
    }
    float face(int k) { return at_face(k, below(cells_.extent[k] + 1)); }
    // In the grid, or a little outside of it.
    glm::vec3 anywhere() {
        glm::vec3 point;
        for (int k = 0; k < 3; ++k) {
            const float part = static_cast<float>(random_() >> 8) * 0x1p-24F * 1.2F - 0.1F;
            point[k] = cells_.origin[k] +
                       part * static_cast<float>(cells_.extent[k] * grid::cell_side(cells_));
        }
        return point;
    }
    const grid::GridTriangle& pick() { return triangles_[random_() % triangles_.size()]; }
    glm::vec3 corner() { return triangles_.empty() ? anywhere() : pick().a; }

    const grid::GridCells& cells_;
    std::span<const grid::GridTriangle> triangles_;
    std::mt19937 random_;
};

}  // namespace

std::vector<Segment> make_segments(std::size_t count, const grid::GridCells& cells,
                                   std::span<const grid::GridTriangle> triangles,
                                   std::uint32_t seed) {
    Generator generator(cells, triangles, seed);
    std::vector<Segment> segments;
    segments.reserve(count);
    for (std::size_t i = 0; i < count; ++i) segments.push_back(generator.make(i % kinds.size()));
    return segments;
}

std::vector<Segment> make_random_segments(std::size_t count, const grid::GridCells& cells,
                                          std::uint32_t seed) {
    Generator generator(cells, {}, seed);
    std::vector<Segment> segments;
    segments.reserve(count);
    for (std::size_t i = 0; i < count; ++i) segments.push_back(generator.make(0));
    return segments;
}

std::vector<grid::GridSegment> to_device(std::span<const Segment> segments) {
    std::vector<grid::GridSegment> result;
    result.reserve(segments.size());
    for (const Segment& segment : segments)
        result.push_back({{{segment.from.x, segment.from.y, segment.from.z, 0}},
                          {{segment.to.x, segment.to.y, segment.to.z, 0}}});
    return result;
}

void add_flat_triangles(std::vector<grid::GridTriangle>& triangles) {
    const std::size_t count = std::min<std::size_t>(triangles.size(), 8);
    for (std::size_t i = 0; i < count; ++i) {
        const grid::GridTriangle triangle = triangles[i * triangles.size() / count];
        triangles.push_back({triangle.a, triangle.a, triangle.a});
        triangles.push_back({triangle.a, triangle.b, triangle.a});
        triangles.push_back({triangle.a, 0.5F * (triangle.a + triangle.b), triangle.b});
    }
}

}  // namespace triangle_grid
