// SPDX-License-Identifier: MIT
// What is blocked is dark, and nothing else is.
#include "reference.hpp"
#include "shadows/support/squares.hpp"
#include "support/catch.hpp"
#include "support/device.hpp"

namespace cellist::test {
namespace {

TEST_CASE("no indirect light passes a wall") {
    for (const auto& [reduce, interleave] : {std::pair{1, 1}, {4, 2}, {3, 4}, {16, 4}}) {
        INFO(reduce << ", " << interleave);
        shadows::Settings settings = small_settings(64, 48, 8);
        settings.reduce = reduce;
        settings.interleave = interleave;
        const shadows::Scene scene = facing_squares(3, true);
        shadows::Renderer renderer(device(), scene, settings);
        renderer.draw(scene);
        const auto picture = renderer.picture().download();
        const auto unblocked = renderer.unblocked().download();
        for (std::size_t p = 0; p < picture.size(); ++p)
            for (int channel = 0; channel < 3; ++channel) {
                REQUIRE(channel_of(unblocked[p], channel) > 0.001);
                REQUIRE(channel_of(picture[p], channel) <=
                        1e-5 * channel_of(unblocked[p], channel));
            }
        CHECK(renderer.counts().blocked == renderer.counts().rays);
    }
}

TEST_CASE("where nothing blocks, B is 0") {
    shadows::Scene scene = facing_squares(3, false);
    scene.light.is_spot = false;  // all samples send light
    shadows::Renderer renderer(device(), scene, small_settings(64, 48, 8));
    renderer.draw(scene);
    for (const cl_float4& pixel : renderer.b().download())
        for (int channel = 0; channel < 3; ++channel) REQUIRE(channel_of(pixel, channel) == 0);
    const auto picture = renderer.picture().download();
    const auto unblocked = renderer.unblocked().download();
    for (std::size_t p = 0; p < picture.size(); ++p)
        for (int channel = 0; channel < 3; ++channel)
            REQUIRE(channel_of(picture[p], channel) == channel_of(unblocked[p], channel));
    CHECK(renderer.counts().blocked == 0);
    CHECK(renderer.counts().rays == 64 * 48 * 64);
}

TEST_CASE("A, B and the picture are those of double precision") {
    const shadows::Scene room = shadows::make_room();
    const shadows::Scene swarm = shadows::make_swarm(8000);
    for (const shadows::Scene* scene : {&room, &swarm}) {
        shadows::Renderer renderer(device(), *scene, small_settings(48, 36, 4));
        renderer.draw(*scene);
        const shadows::Reference reference = make_reference(renderer);
        REQUIRE(reference.pixels.size() == 48 * 36);
        const auto a = renderer.a().download(), b = renderer.b().download(),
                   picture = renderer.picture().download();
        double most = 0;
        for (const glm::dvec3& light : reference.a) most = std::max(most, light.x);
        REQUIRE(most > 0.1);
        std::size_t apart = 0, dark = 0;
        for (std::size_t p = 0; p < a.size(); ++p)
            for (int channel = 0; channel < 3; ++channel) {
                const double error = 1e-5 * most;
                REQUIRE(std::abs(channel_of(a[p], channel) - reference.a[p][channel]) <= error);
                if (reference.b[p][channel] > 0) ++dark;
                // The ends of rays are rounded: some that graze an edge may differ.
                if (std::abs(channel_of(b[p], channel) - reference.b[p][channel]) > error) ++apart;
                if (std::abs(channel_of(picture[p], channel) - reference.picture[p][channel]) >
                    error)
                    ++apart;
            }
        CHECK(dark > 300);
        CHECK(apart <= 6);
    }
}

}  // namespace
}  // namespace cellist::test
