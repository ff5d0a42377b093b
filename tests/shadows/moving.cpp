// SPDX-License-Identifier: MIT
// The grid follows what moves, and the same frame is the same picture.
#include <algorithm>
#include <cstring>

#include "grid/rays.hpp"
#include "image.hpp"
#include "shadows/support/squares.hpp"
#include "support/catch.hpp"
#include "support/device.hpp"

namespace cellist::test {
namespace {

// Where the host says that the blockers are, in double precision.
std::vector<glm::dvec3> host_corners(const shadows::Scene& scene) {
    std::vector<glm::dvec3> corners;
    for (const shadows::Instance& instance : scene.instances) {
        if (!instance.blocks) continue;
        const support::Mesh& mesh = scene.meshes[instance.mesh];
        for (const auto& triangle : mesh.triangles)
            for (const std::uint32_t vertex : triangle)
                corners.emplace_back(instance.to_world * glm::dvec4(mesh.positions[vertex], 1));
    }
    return corners;
}

std::vector<std::vector<cl_uint>> sorted_lists(const grid::TriangleGrid& grid) {
    const auto lists = grid.entries().download();
    std::vector<std::vector<cl_uint>> result;
    for (std::size_t cell = 0; cell < grid.entries().shape().cells(); ++cell) {
        const auto found = lists.cell(cell);
        std::vector<cl_uint>& list = result.emplace_back(found.begin(), found.end());
        std::sort(list.begin(), list.end());
    }
    return result;
}

TEST_CASE("the grid of a moving scene is that of its triangles at the time") {
    shadows::Scene scene = shadows::make_swarm(8000);
    shadows::Settings settings = small_settings(16, 12, 4);
    settings.storage = Storage::counted;
    shadows::Renderer renderer(device(), scene, settings);
    std::vector<std::vector<cl_uint>> previous;
    for (const double seconds : {0.0, 0.3, 2.7, 100.0, 0.3}) {
        INFO(seconds);
        scene.move(scene, seconds);
        renderer.draw(scene);
        const auto triangles = renderer.grid().triangles().download();
        const std::vector<glm::dvec3> corners = host_corners(scene);
        REQUIRE(corners.size() == 3 * triangles.size());
        double apart = 0;
        for (std::size_t i = 0; i < triangles.size(); ++i)
            for (std::size_t k = 0; k < 3; ++k) {
                const glm::vec3 corner = k == 0   ? triangles[i].a
                                         : k == 1 ? triangles[i].b
                                                  : triangles[i].c;
                const glm::dvec3 off = glm::abs(glm::dvec3(corner) - corners[3 * i + k]);
                apart = std::max({apart, off.x, off.y, off.z});
            }
        CHECK(apart < 1e-6);
        grid::TriangleGrid rebuilt(device(), triangles, renderer.grid().cells());
        rebuilt.build();
        const auto lists = sorted_lists(renderer.grid());
        CHECK(lists == sorted_lists(rebuilt));
        CHECK(lists != previous);
        previous = lists;
    }
}

template <class T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

TEST_CASE("a frame is the same to the last bit each time") {
    shadows::Scene scene = shadows::make_swarm(8000);
    shadows::Settings settings = small_settings(160, 120, 8);
    settings.reduce = 4;
    settings.interleave = 2;
    shadows::Renderer renderer(device(), scene, settings);
    renderer.draw(scene);
    const auto picture = renderer.picture().download(), a = renderer.a().download(),
               b = renderer.b().download(), blurred = renderer.blurred_b().download();
    const auto emitters = renderer.emitters().download();
    for (int again = 0; again < 3; ++again) {
        scene.move(scene, 1.0);
        renderer.draw(scene);
        CHECK_FALSE(same_bits(renderer.picture().download(), picture));
        scene.move(scene, 0.0);
        renderer.draw(scene);
        CHECK(same_bits(renderer.picture().download(), picture));
        CHECK(same_bits(renderer.a().download(), a));
        CHECK(same_bits(renderer.b().download(), b));
        CHECK(same_bits(renderer.blurred_b().download(), blurred));
        CHECK(same_bits(renderer.emitters().download(), emitters));
    }
    shadows::Renderer other(device(), scene, settings);
    other.draw(scene);
    CHECK(same_bits(other.picture().download(), picture));
}

// An emitter that jumps from a wall to a ring changes them by more.
TEST_CASE("rings that move change the unblocked light of still walls little by little") {
    shadows::Scene scene = shadows::make_swarm(100'000);
    shadows::Renderer renderer(device(), scene, small_settings(64, 48, 8));
    std::vector<shadows::Surface> surfaces;
    std::vector<cl_float4> a;
    double most = 0;
    std::size_t still = 0;
    for (int frame = 0; frame < 12; ++frame) {
        scene.move(scene, 0.02 * frame);
        renderer.draw(scene);
        const std::vector<shadows::Surface> surfaces_now = renderer.surfaces().download();
        const std::vector<cl_float4> a_now = renderer.a().download();
        for (std::size_t p = 0; p < a.size(); ++p) {
            if (std::memcmp(&surfaces[p], &surfaces_now[p], sizeof(shadows::Surface)) != 0)
                continue;
            ++still;
            for (int channel = 0; channel < 3; ++channel) {
                const auto shown = [&](const cl_float4& light) {
                    return support::srgb_from_linear(channel_of(surfaces[p].albedo, channel) *
                                                     channel_of(light, channel) / pi);
                };
                most = std::max(most, std::abs(shown(a_now[p]) - shown(a[p])));
            }
        }
        surfaces = surfaces_now;
        a = a_now;
    }
    CHECK(still > 20'000);
    CHECK(255 * most < 8);
}

TEST_CASE("a light anywhere gives a finite picture") {
    for (const bool is_spot : {true, false})
        for (const glm::dvec3& position :
             {glm::dvec3(-0.75, -0.45, -0.35), glm::dvec3(0.25, -0.4, 0), glm::dvec3(0, -1.05, 0),
              glm::dvec3(0, -1, 0), glm::dvec3(1e3, 1e3, 1e3), glm::dvec3(1.5, -0.25, -0.0999)}) {
            INFO(is_spot << ": " << position.x << ", " << position.y << ", " << position.z);
            shadows::Scene scene = shadows::make_room();
            if (!is_spot) scene.light = shadows::make_parallel_light();
            scene.light.position = position;
            shadows::Renderer renderer(device(), scene, small_settings(64, 48, 8));
            renderer.draw(scene);
            for (const cl_float4& pixel : renderer.picture().download())
                for (int channel = 0; channel < 3; ++channel) {
                    REQUIRE(std::isfinite(channel_of(pixel, channel)));
                    REQUIRE(channel_of(pixel, channel) >= 0);
                }
        }
}

}  // namespace
}  // namespace cellist::test
