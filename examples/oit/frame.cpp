#include "frame.hpp"

#include <algorithm>

namespace oit {

support::Mesh make_floor(const Look& look) {
    const float side = 2 * look.floor_fade_end;
    support::Mesh floor;
    for (const float z : {-side, side})
        for (const float x : {-side, side}) {
            floor.positions.emplace_back(x, look.floor_height, z);
            floor.normals.emplace_back(0.0F, 1.0F, 0.0F);
        }
    floor.triangles = {{0, 2, 3}, {0, 3, 1}};
    return floor;
}

float floor_height_under(const support::Mesh& mesh) {
    // A flat underside that lay in the floor would fight with it for the same depth.
    constexpr float sunk = 0.02F;
    if (mesh.positions.empty()) return -1;
    const auto lower = [](const glm::vec3& a, const glm::vec3& b) { return a.y < b.y; };
    const auto [lowest, highest] =
        std::minmax_element(mesh.positions.begin(), mesh.positions.end(), lower);
    return lowest->y + sunk * (highest->y - lowest->y);
}

}  // namespace oit
