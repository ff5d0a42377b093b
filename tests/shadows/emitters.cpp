// SPDX-License-Identifier: MIT
// Samples of the reflective shadow map send the light that theory says.
#include <algorithm>
#include <cmath>
#include <vector>

#include <glm/geometric.hpp>

#include "shadows/support/squares.hpp"
#include "support/catch.hpp"
#include "support/device.hpp"

namespace cellist::test {
namespace {

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
        REQUIRE(emitters.size() == static_cast<std::size_t>(2 * samples * samples));
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
        if (channel_of(emitter.power, 0) > 0)
            CHECK(is_close(channel_of(emitter.position, 2), -1, 1e-6));
}

glm::dvec3 vector_of(const cl_float4& v) { return {v.s[0], v.s[1], v.s[2]}; }

// A texel of the reflective shadow map as a disc that sends light.
struct Texel {
    glm::dvec3 position{0}, normal{0}, power{0};
    double weight = 0;          // all of its power
    double squared_radius = 0;  // of the disc
};

// By the light's definition, in double precision. `u` and `v` are from -1 to 1 across the map.
Texel texel_of(const support::Light& light, const shadows::Surface& surface, int rsm, double u,
               double v) {
    Texel texel{vector_of(surface.position), vector_of(surface.normal)};
    const glm::dvec3 axis = glm::normalize(light.target - light.position);
    glm::dvec3 from_light = axis;
    double area = light.side * light.side / (rsm * rsm), received = area;
    if (light.is_spot) {
        from_light = texel.position - light.position;
        const double half = std::tan(light.field_degrees * pi / 360);
        const double solid_angle =
            4 * half * half / (rsm * rsm) / std::pow(1 + half * half * (u * u + v * v), 1.5);
        const double t = std::clamp((1 - (u * u + v * v)) / 0.2, 0.0, 1.0);
        received = solid_angle * t * t * (3 - 2 * t);
        area = solid_angle * glm::dot(from_light, from_light);
    }
    texel.power = vector_of(surface.albedo) * glm::dvec3(light.intensity) * received;
    texel.weight = texel.power.x + texel.power.y + texel.power.z;
    const double facing = -glm::dot(glm::normalize(from_light), texel.normal);
    texel.squared_radius = area / std::max(facing, 0.1) / pi;
    return texel;
}

// Checks an emitter against the texels that it stands for.
void check_emitter(const shadows::Emitter& emitter, const std::vector<Texel>& texels) {
    glm::dvec3 power(0), position(0), normal(0);
    double weight = 0;
    for (const Texel& texel : texels) {
        power += texel.power;
        weight += texel.weight;
        position += texel.weight * texel.position;
        normal += texel.weight * texel.normal;
    }
    if (weight == 0) {
        CHECK(vector_of(emitter.power) == glm::dvec3(0));
        return;
    }
    position /= weight;
    normal = glm::normalize(normal);
    double heights = 0, squared_radius = 0;
    for (const Texel& texel : texels) {
        const glm::dvec3 off = texel.position - position;
        heights += texel.weight * glm::dot(off, normal) * glm::dot(off, normal);
        // The mean square of the distance from the middle of a disc is half its squared radius.
        squared_radius += texel.weight * (2 * glm::dot(off, off) + texel.squared_radius);
    }
    CHECK(glm::distance(vector_of(emitter.power), power) < 1e-4 * glm::length(power));
    CHECK(glm::distance(vector_of(emitter.position), position) < 1e-5);
    CHECK(glm::distance(vector_of(emitter.normal), normal) < 1e-5);
    const double above = 0.001 + 2 * std::sqrt(heights / weight);
    CHECK(std::abs(channel_of(emitter.normal, 3) - above) < 1e-5);
    CHECK(is_close(channel_of(emitter.power, 3), squared_radius / weight, 1e-3));
}

TEST_CASE("emitters are the means of the walls and of the blockers in their parts of the map") {
    constexpr int rsm = 64;
    for (const bool is_spot : {true, false})
        for (const int samples : {1, 8, 32, 64}) {
            INFO(is_spot << ", " << samples);
            shadows::Scene scene = shadows::make_swarm(20000);
            if (!is_spot) scene.light = shadows::make_parallel_light();
            shadows::Renderer renderer(device(), scene, small_settings(8, 8, samples));
            renderer.draw(scene);
            const std::vector<shadows::Surface> lit = renderer.lit().download();
            const std::size_t count = static_cast<std::size_t>(samples * samples);
            std::vector<std::vector<Texel>> texels(2 * count);  // of each emitter
            for (int y = 0; y < rsm; ++y)
                for (int x = 0; x < rsm; ++x) {
                    const shadows::Surface& surface = lit[static_cast<std::size_t>(y * rsm + x)];
                    if (surface.position.s[3] == 0) continue;
                    const auto across = [](int i) { return (2 * i + 1.0) / rsm - 1; };
                    const auto sample =
                        static_cast<std::size_t>(y * samples / rsm * samples + x * samples / rsm);
                    texels[surface.albedo.s[3] == 0 ? sample : sample + count].push_back(
                        texel_of(scene.light, surface, rsm, across(x), across(y)));
                }
            const std::vector<shadows::Emitter> emitters = renderer.emitters().download();
            REQUIRE(emitters.size() == texels.size());
            std::size_t of_blockers = 0;
            for (std::size_t i = 0; i < emitters.size(); ++i) {
                check_emitter(emitters[i], texels[i]);
                if (i >= count && channel_of(emitters[i].power, 0) > 0) ++of_blockers;
            }
            CHECK(of_blockers > 0);
        }
}

}  // namespace
}  // namespace cellist::test
