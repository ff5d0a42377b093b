// SPDX-License-Identifier: MIT
// Every ray of B gets the exact answer, and each sample is asked once.
#include <map>
#include <set>
#include <tuple>

#include "grid/exact.hpp"
#include "shadows/support/squares.hpp"
#include "support/catch.hpp"
#include "support/device.hpp"

namespace cellist::test {
namespace {

glm::vec3 end_of(const cl_float4& v) { return {v.s[0], v.s[1], v.s[2]}; }

TEST_CASE("visibility is that of asking every triangle") {
    shadows::Scene swarm = shadows::make_swarm(20000);
    swarm.move(swarm, 1.3);
    for (const shadows::Scene& scene : {shadows::make_room(), swarm})
        for (const Storage storage : {Storage::linked, Storage::counted}) {
            shadows::Settings settings = small_settings(64, 48, 8);
            settings.reduce = 4;
            settings.interleave = 2;
            settings.storage = storage;
            shadows::Renderer renderer(device(), scene, settings);
            std::size_t blocked = 0, open = 0, different = 0;
            renderer.draw(scene, nullptr,
                          [&](const auto& rays, std::size_t count, const auto& answers) {
                              const auto triangles = renderer.grid().triangles().download();
                              const auto segments = rays.download();
                              const auto bits = answers.download();
                              for (std::size_t i = 0; i < count; ++i) {
                                  const bool expected = grid::meets_any(
                                      end_of(segments[i].from), end_of(segments[i].to), triangles);
                                  ++(expected ? blocked : open);
                                  if (expected != (bits[i] != 0)) ++different;
                              }
                          });
            CHECK(different == 0);
            CHECK(blocked > 50);
            CHECK(open > 100);
        }
}

TEST_CASE("neighbours in a square take each sample once") {
    for (const auto& [samples, interleave] : {std::pair{4, 1}, {4, 2}, {8, 2}, {8, 4}, {8, 8}}) {
        INFO(samples << ", " << interleave);
        shadows::Settings settings = small_settings(24, 16, samples);
        settings.interleave = interleave;
        shadows::Scene scene = facing_squares(3, false);
        scene.light.is_spot = false;  // all samples send light
        shadows::Renderer renderer(device(), scene, settings);
        // The samples of each square of pixels, by their positions.
        std::map<std::pair<std::size_t, std::size_t>, std::multiset<std::pair<float, float>>> asked;
        const auto width = static_cast<std::size_t>(renderer.b_width());
        const auto square = static_cast<std::size_t>(interleave);
        renderer.draw(scene, nullptr, [&](const auto& rays, std::size_t count, const auto&) {
            const auto segments = rays.download();
            const std::size_t places = width * static_cast<std::size_t>(renderer.b_height());
            for (std::size_t i = 0; i < count; ++i) {
                if (end_of(segments[i].from) == end_of(segments[i].to))
                    continue;  // no blocker sends light
                const std::size_t x = i % places % width, y = i % places / width;
                asked[{x / square, y / square}].insert({segments[i].to.s[0], segments[i].to.s[1]});
            }
        });
        CHECK(asked.size() == 24 / square * (16 / square));
        for (const auto& [at, targets] : asked) {
            REQUIRE(targets.size() == static_cast<std::size_t>(samples * samples));
            REQUIRE(std::set(targets.begin(), targets.end()).size() == targets.size());
        }
    }
}

}  // namespace
}  // namespace cellist::test
