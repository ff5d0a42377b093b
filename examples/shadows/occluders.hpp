#pragma once

#include <memory>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "grid/triangle_grid.hpp"

namespace shadows {

/// Triangles that block segments, on the CPU: Embree where it was found, else every triangle.
class Occluders {
public:
    explicit Occluders(std::vector<grid::GridTriangle> triangles);
    ~Occluders();
    Occluders(const Occluders&) = delete;
    Occluders& operator=(const Occluders&) = delete;

    /// "Embree 3.13.5" or "every triangle".
    [[nodiscard]] static std::string name();
    /// The cost of a segment, in triangles. Some dozens with Embree.
    [[nodiscard]] double cost() const;

    /// Whether any triangle meets the segment. Embree may be wrong where the segment grazes one.
    [[nodiscard]] bool block(const glm::vec3& from, const glm::vec3& to) const;
    /// The same, exactly.
    [[nodiscard]] bool block_exactly(const glm::vec3& from, const glm::vec3& to) const;

private:
    struct Tree;
    std::vector<grid::GridTriangle> triangles_;
    std::unique_ptr<Tree> tree_;
};

}  // namespace shadows
