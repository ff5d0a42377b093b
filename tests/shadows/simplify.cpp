// SPDX-License-Identifier: MIT
// Merged vertices leave closed meshes closed, and stay in their cells.
#include <map>

#include <glm/common.hpp>

#include "scene.hpp"
#include "support/catch.hpp"

namespace cellist::test {
namespace {

// Whether each edge has an even number of triangles, so that the mesh has no border.
bool is_closed(const support::Mesh& mesh) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> triangles;
    for (const auto& t : mesh.triangles)
        for (std::size_t k = 0; k < 3; ++k) ++triangles[std::minmax(t[k], t[(k + 1) % 3])];
    for (const auto& [edge, count] : triangles)
        if (count % 2 != 0) return false;
    return true;
}

TEST_CASE("a simplified mesh is closed, smaller, and in the cells of the mesh") {
    for (const support::Mesh& mesh :
         {shadows::make_room().meshes[1], shadows::make_swarm(784).meshes[1]}) {
        REQUIRE(is_closed(mesh));
        glm::vec3 low(1e9F), high(-1e9F);
        for (const glm::vec3& p : mesh.positions) {
            low = glm::min(low, p);
            high = glm::max(high, p);
        }
        const glm::vec3 size = high - low;
        const float longest = std::max({size.x, size.y, size.z});
        std::size_t previous = mesh.triangles.size();
        for (const int cells : {16, 8, 4}) {
            INFO(cells);
            const support::Mesh coarse = shadows::simplify(mesh, cells);
            CHECK(is_closed(coarse));
            CHECK(coarse.triangles.size() < previous);
            CHECK_FALSE(coarse.triangles.empty());
            previous = coarse.triangles.size();
            // One vertex a cell, each in the cell of a vertex of the mesh.
            const float side = longest / static_cast<float>(cells);
            std::map<std::tuple<int, int, int>, int> used;
            for (const glm::vec3& p : coarse.positions) {
                const glm::ivec3 cell = glm::min(glm::ivec3((p - low) / side), cells - 1);
                CHECK(++used[{cell.x, cell.y, cell.z}] == 1);
            }
        }
        CHECK(shadows::simplify(mesh, 1).triangles.empty());
    }
}

TEST_CASE("a mesh without triangles stays one") {
    CHECK(shadows::simplify({}, 4).triangles.empty());
}

}  // namespace
}  // namespace cellist::test
