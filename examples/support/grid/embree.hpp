// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <span>
#include <string>

#include <glm/vec3.hpp>

#include "grid/triangle_grid.hpp"

namespace grid {

/// Whether this build has Embree (libembree-dev).
[[nodiscard]] bool has_embree();

/// Triangles in Embree's tree, in its robust mode: a second opinion on segments, and a rival.
class EmbreeTriangles {
public:
    /// Throws Error without Embree.
    explicit EmbreeTriangles(std::span<const GridTriangle> triangles);
    ~EmbreeTriangles();
    EmbreeTriangles(const EmbreeTriangles&) = delete;
    EmbreeTriangles& operator=(const EmbreeTriangles&) = delete;

    /// "Embree 3.13.5"
    [[nodiscard]] static std::string name();

    /// Builds the tree again, as for triangles that have moved.
    void rebuild();

    /// Whether the segment meets a triangle. May be wrong where the segment grazes one. Several
    /// threads may ask at once.
    [[nodiscard]] bool meets_any(const glm::vec3& from, const glm::vec3& to) const;

private:
    struct Tree;
    std::unique_ptr<Tree> tree_;
};

}  // namespace grid
