// Samples of the reflective shadow map send the light that theory says.
#include <numbers>

#include "shadows/support/squares.hpp"
#include "support/catch.hpp"
#include "support/device.hpp"

namespace cellist::test {
namespace {

constexpr double pi = std::numbers::pi;

TEST_CASE("a disc of light shines on a parallel square in front of it as theory says") {
    // One sample for the whole map, so one disc. Its power is albedo * intensity * solid angle.
    const double side = 2 * std::tan(pi / 6), area = side * side;
    for (const double distance : {2.0, 3.0, 10.0, 1000.0}) {
        INFO(distance);
        shadows::Settings settings = small_settings(65, 65, 1);
        settings.rsm = 1;
        const shadows::Scene scene = facing_squares(distance, false);
        shadows::Renderer renderer(device(), scene, settings);
        renderer.draw(scene);
        const cl_float4 middle = renderer.a().download()[32 * 65 + 32];
        const double albedo[] = {0.5, 0.25, 1};
        for (int channel = 0; channel < 3; ++channel) {
            // The form factor from a point to a coaxial parallel disc of radius R at distance d is
            // R^2 / (R^2 + d^2).
            const double radiosity = albedo[channel] * 3;  // power / area, at distance 1
            const double squared_radius = area / pi;
            const double expected =
                radiosity * squared_radius / (squared_radius + distance * distance);
            CHECK(is_close(channel_of(middle, channel), expected, 1e-5));
        }
    }
}

TEST_CASE("far from a sample, light falls with the square of the distance") {
    const auto light_at = [](double distance) {
        const shadows::Scene scene = facing_squares(distance, false);
        shadows::Renderer renderer(device(), scene, small_settings(33, 33, 1));
        renderer.draw(scene);
        return channel_of(renderer.a().download()[16 * 33 + 16], 0);
    };
    CHECK(is_close(light_at(200) / light_at(400), 4, 1e-3));
}

// The power of a spot light of intensity 1 through its cone: the integral of its fade over the
// solid angle, in rings of the image.
double spot_power(double field_degrees) {
    const double reach = std::tan(0.5 * field_degrees * pi / 180);
    double power = 0;
    constexpr int rings = 100'000;
    for (int i = 0; i < rings; ++i) {
        const double r = (i + 0.5) / rings;
        const double t = std::clamp((r * r - 1) / (0.8 - 1), 0.0, 1.0);
        const double fade = t * t * (3 - 2 * t);
        power +=
            fade * 2 * pi * reach * reach * r / std::pow(1 + reach * reach * r * r, 1.5) / rings;
    }
    return power;
}

TEST_CASE("the samples of a closed room have the power of the spot light") {
    shadows::Scene scene = shadows::make_room();
    for (shadows::Instance& instance : scene.instances) instance.albedo = {1, 1, 1};
    // Turned into the room, so that all of its light meets a wall.
    scene.light.position = {0.2, 0.1, 0.9};
    scene.light.target = {-0.3, -0.1, -1};
    const double expected =
        spot_power(scene.light.field_degrees) * static_cast<double>(scene.light.intensity.x);
    for (const auto& [rsm, samples, error] :
         {std::tuple{256, 256, 1e-3}, {256, 64, 1e-3}, {256, 16, 1e-2}, {256, 8, 5e-2}}) {
        INFO(rsm << ", " << samples);
        shadows::Settings settings = small_settings(8, 8, samples);
        settings.rsm = rsm;
        settings.reduce = 8;
        shadows::Renderer renderer(device(), scene, settings);
        renderer.draw(scene);
        const std::vector<shadows::Emitter> emitters = renderer.emitters().download();
        REQUIRE(emitters.size() == static_cast<std::size_t>(samples * samples));
        double power = 0;
        for (const shadows::Emitter& emitter : emitters) power += channel_of(emitter.power, 0);
        CHECK(is_close(power, expected, error));
    }
}

TEST_CASE("parallel light brings its intensity times the area that it shines through") {
    shadows::Scene scene = facing_squares(3, false);
    scene.light.is_spot = false;
    scene.light.side = 1.5;
    shadows::Renderer renderer(device(), scene, small_settings(8, 8, 64));
    renderer.draw(scene);
    double power = 0;
    for (const shadows::Emitter& emitter : renderer.emitters().download())
        power += channel_of(emitter.power, 2);
    CHECK(is_close(power, 3 * 1.5 * 1.5, 1e-5));
}

TEST_CASE("parallel light begins at its position") {
    // A square above the light would hide the one below it.
    shadows::Scene scene = facing_squares(3, true);
    scene.light.is_spot = false;
    shadows::Renderer renderer(device(), scene, small_settings(8, 8, 8));
    renderer.draw(scene);
    for (const shadows::Emitter& emitter : renderer.emitters().download())
        CHECK(is_close(channel_of(emitter.position, 2), -1, 1e-6));
}

}  // namespace
}  // namespace cellist::test
