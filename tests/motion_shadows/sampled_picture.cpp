// SPDX-License-Identifier: MIT
// What the samples of a picture see, and whether they are in shadow: the device against double
// precision, with all triangles that come near.
#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <random>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "accumulate.hpp"
#include "renderer.hpp"
#include "support/catch.hpp"
#include "support/device.hpp"
#include "support/oracle.hpp"
#include "support/random.hpp"

namespace cellist::test {
namespace {

// Places are rounded by less than this many pixels.
constexpr double place_rounding = 1e-4;
constexpr cl_uint none = 0xFFFFFFFF, blocked_bit = 0x80000000;

// The definitions of moving.clh.
std::uint32_t hash32(std::uint32_t x) {
    x ^= x >> 16;
    x *= 0x7feb352dU;
    x ^= x >> 15;
    x *= 0x846ca68bU;
    return x ^ x >> 16;
}

float unit_float(std::uint32_t bits) { return static_cast<float>(bits >> 8) * 0x1p-24F; }

float sample_time(std::uint32_t pixel, std::uint32_t sample, std::uint32_t samples) {
    const float u = unit_float(hash32(hash32(pixel * 2) + sample));
    return std::min((static_cast<float>(sample) + u) / static_cast<float>(samples), 0x1.fffffep-1F);
}

glm::vec2 sample_offset(std::uint32_t pixel, std::uint32_t sample) {
    return {unit_float(hash32(pixel + 0x9e3779b9U) + sample * 3242174889U) - 0.5F,
            unit_float(hash32(pixel + 0x3c6ef372U) + sample * 2447445414U) - 0.5F};
}

// A depth, and how much it changes within the rounding of places.
struct RoundedDepth {
    double depth, rounding;
};

RoundedDepth depth_at(const DoubleTriangle& t, const glm::dvec2& place, double time) {
    const double depth = at_moment(t, place, time).depth;
    double rounding = 4e-6 * std::abs(depth);
    for (const glm::dvec2& step : {glm::dvec2(place_rounding, 0), glm::dvec2(0, place_rounding)})
        rounding += std::abs(at_moment(t, place + step, time).depth - depth);
    return {depth, rounding};
}

// A view of the scene in double precision.
struct HostView {
    HostView(const motion::Scene& scene, const motion::SeenScene& seen)
        : view(seen.view),
          vertices(exactly(seen.vertices.download())),
          grid(vertices, scene.triangles, view) {}
    motion::View view;
    std::vector<DoubleVertex> vertices;
    TriangleGrid grid;
};

// What the host says of a shadow test.
struct HostReceiver {
    bool is_certain = false;      ///< no decision is within rounding
    bool is_lit_at_most = false;  ///< faces away from the light, or is out of its image
    std::size_t texel = 0;
    double limit = 0, rounding = 0, pixel = 0;
};

class HostPicture {
public:
    HostPicture(const motion::Scene& its_scene, motion::Frame& frame)
        : scene(its_scene),
          camera(scene, frame.camera),
          light(scene, frame.light),
          bias(double(frame.settings.bias)) {}

    [[nodiscard]] DoubleTriangle triangle(const HostView& view, std::uint32_t i) const {
        return triangle_of(view.vertices, scene.triangles[i]);
    }

    // Whether a triangle, or none, may be the nearest at a place; `guess` becomes the nearest one.
    [[nodiscard]] bool may_see(cl_uint seen, std::size_t pixel, const glm::dvec2& place,
                               double time, cl_uint& guess) const {
        double bound = std::numeric_limits<double>::infinity(), nearest = bound;
        guess = none;
        double seen_least = seen == none ? 0 : bound;
        for (const std::uint32_t i : camera.grid.near(pixel)) {
            const DoubleTriangle t = triangle(camera, i);
            const double inside = at_moment(t, place, time).inside;
            if (!(inside > -place_rounding)) continue;
            const RoundedDepth d = depth_at(t, place, time);
            if (!(d.depth >= double(camera.view.near_depth))) continue;
            if (inside >= 0 && d.depth < nearest) {
                nearest = d.depth;
                guess = i;
            }
            if (inside > place_rounding) bound = std::min(bound, d.depth + d.rounding);
            if (i == seen) seen_least = d.depth - d.rounding;
        }
        return seen == none ? bound == std::numeric_limits<double>::infinity()
                            : seen_least <= bound;
    }

    // The shadow test as receiver.clh documents it.
    [[nodiscard]] HostReceiver receiver(cl_uint seen, const glm::dvec2& place, double time) const {
        HostReceiver r;
        const DoubleTriangle from_camera = triangle(camera, seen);
        const DoubleTriangle from_light = triangle(light, seen);
        glm::dvec3 weights(0);
        std::array<glm::dvec4, 3> v, lit;
        std::array<glm::dvec3, 3> position;
        for (std::size_t k = 0; k < 3; ++k) {
            v[k] = glm::mix(from_camera.vertex[k].begin, from_camera.vertex[k].end, time);
            lit[k] = glm::mix(from_light.vertex[k].begin, from_light.vertex[k].end, time);
            const auto vertex = scene.triangles[seen][int(k)];
            position[k] =
                glm::mix(glm::dvec3(scene.begin[vertex]), glm::dvec3(scene.end[vertex]), time);
        }
        for (std::size_t k = 0; k < 3; ++k) {
            const glm::dvec4 &a = v[(k + 1) % 3], &b = v[(k + 2) % 3];
            weights[int(k)] = (a.x - place.x * a.z) * (b.y - place.y * b.z) -
                              (a.y - place.y * a.z) * (b.x - place.x * b.z);
        }
        weights /= weights.x + weights.y + weights.z;
        const glm::dvec3 at =
            weights.x * position[0] + weights.y * position[1] + weights.z * position[2];
        glm::dvec3 normal =
            glm::normalize(glm::cross(position[1] - position[0], position[2] - position[0]));
        if (glm::dot(normal, at - scene.eye) > 0) normal = -normal;
        const glm::dvec3 to_light = scene.light.is_spot ? scene.light.position - at
                                                        : scene.light.position - scene.light.target;
        const double facing = glm::dot(normal, glm::normalize(to_light));
        const double facing_camera = glm::dot(normal, glm::normalize(scene.eye - at));
        if (std::abs(facing) < 1e-4 || facing_camera < 1e-3) return r;
        if (facing < 0) {
            r.is_certain = r.is_lit_at_most = true;
            return r;
        }
        const glm::dvec4 seen_at = weights.x * lit[0] + weights.y * lit[1] + weights.z * lit[2];
        const glm::dvec2 half(0.5 * light.view.width, 0.5 * light.view.height);
        const glm::dvec2 image = glm::dvec2(seen_at) / seen_at.z + half;
        const glm::dvec2 to_border = glm::abs(image - glm::round(image));
        if (std::min(to_border.x, to_border.y) < 2e-3) return r;
        r.is_certain = true;
        if (image.x < 0 || image.y < 0 || image.x >= light.view.width ||
            image.y >= light.view.height) {
            r.is_lit_at_most = true;
            return r;
        }
        r.texel = static_cast<std::size_t>(image.y) * static_cast<std::size_t>(light.view.width) +
                  static_cast<std::size_t>(image.x);
        r.pixel = double(light.view.pixel) * (light.view.is_parallel != 0 ? 1 : seen_at.w);
        const RoundedDepth plane = depth_at(from_light, centre_of(light.view, r.texel), time);
        const double most = 64 * r.pixel;
        const double slope = plane.depth - seen_at.w;
        r.limit = seen_at.w - bias * r.pixel + std::clamp(slope, -most, most);
        // The place on the light's image is rounded, too; a clamped slope is not.
        r.rounding = 8e-6 * seen_at.w + (std::abs(slope) < most ? 8 * plane.rounding : 0);
        if (std::abs(std::abs(slope) - most) < 8 * plane.rounding) r.is_certain = false;
        return r;
    }

    struct Blocked {
        bool certainly, possibly, guess;
    };
    // `tolerance` is added to rounding. `own` blocks only if it is not `seen`.
    [[nodiscard]] Blocked blocked(const HostReceiver& r, cl_uint seen, double time,
                                  double tolerance) const {
        Blocked b{};
        if (r.is_lit_at_most) return b;
        const glm::dvec2 place = centre_of(light.view, r.texel);
        const double near_depth = double(light.view.near_depth);
        for (const std::uint32_t i : light.grid.near(r.texel)) {
            // Merged ranges do not know their triangle.
            if (i == seen && tolerance == 0) continue;
            const DoubleTriangle t = triangle(light, i);
            const double inside = at_moment(t, place, time).inside;
            if (!(inside > -place_rounding)) continue;
            const RoundedDepth d = depth_at(t, place, time);
            const double rounding = d.rounding + r.rounding + tolerance;
            if (d.depth < near_depth - rounding) continue;
            b.possibly = b.possibly || d.depth < r.limit + rounding;
            if (i == seen) continue;
            b.certainly = b.certainly || (inside > place_rounding && d.depth < r.limit - rounding &&
                                          d.depth > near_depth + rounding);
            b.guess = b.guess || (inside >= 0 && d.depth >= near_depth && d.depth < r.limit);
        }
        return b;
    }

    const motion::Scene& scene;
    HostView camera, light;
    double bias;
};

TEST_CASE("samples see what double precision sees, and their shadows are the same") {
    for (const motion::Scene& scene :
         {motion::make_cubes(), motion::make_blinds(), motion::make_fan()}) {
        for (const bool compress : {false, true}) {
            INFO(scene.name << (compress ? ", compressed" : ""));
            CELLIST_RANDOM(random, 6);
            motion::Settings settings;
            settings.width = 160;
            settings.height = 120;
            settings.shadow_map = 256;
            settings.samples = 8;
            settings.compress = compress;
            motion::Renderer renderer(device(), scene, settings);
            const auto method = motion::make_exact(renderer.frame());
            renderer.draw(*method);
            motion::Frame& frame = renderer.frame();
            const std::vector<motion::Receiver> receivers = frame.receivers.download();
            const HostPicture host(scene, frame);
            std::size_t other_triangle = 0, wrong_triangle = 0, wrong_receiver = 0,
                        wrong_shadow = 0, other_shadow = 0, uncertain = 0, dark = 0;
            constexpr std::size_t tries = 10'000;
            for (std::size_t i = 0; i < tries; ++i) {
                const std::uint32_t pixel = below(random, std::uint32_t(frame.pixels()));
                const std::uint32_t sample = below(random, settings.samples);
                const motion::Receiver device_says = receivers[sample * frame.pixels() + pixel];
                const auto time = double(sample_time(pixel, sample, settings.samples));
                const glm::dvec2 place(glm::vec2(centre_of(frame.camera.view, pixel)) +
                                       sample_offset(pixel, sample));
                const cl_uint seen =
                    device_says.triangle == none ? none : device_says.triangle & ~blocked_bit;
                cl_uint guess;
                if (!host.may_see(seen, pixel, place, time, guess)) ++wrong_triangle;
                if (guess != seen) ++other_triangle;
                if (seen == none) continue;
                const HostReceiver r = host.receiver(seen, place, time);
                if (!r.is_certain) {
                    ++uncertain;
                    continue;
                }
                if ((device_says.texel == none) != r.is_lit_at_most) {
                    ++wrong_receiver;
                    continue;
                }
                if (r.is_lit_at_most) continue;
                if (device_says.texel != r.texel ||
                    !(std::abs(double(device_says.limit) - r.limit) <= r.rounding))
                    ++wrong_receiver;
                const bool is_dark = device_says.triangle != seen;
                dark += is_dark ? 1 : 0;
                const HostPicture::Blocked b = host.blocked(
                    r, seen, time, compress ? double(settings.tolerance) * r.pixel : 0);
                if ((b.certainly && !is_dark) || (is_dark && !b.possibly)) ++wrong_shadow;
                if (b.guess != is_dark) ++other_shadow;
            }
            std::cout << scene.name << (compress ? ", compressed" : "") << ": of " << tries
                      << " samples " << other_triangle << " see another triangle ("
                      << wrong_triangle << " beyond rounding), " << dark << " are dark, "
                      << other_shadow << " differ in shadow (" << wrong_shadow
                      << " beyond rounding), " << uncertain << " are uncertain\n";
            CHECK(wrong_triangle == 0);
            CHECK(wrong_receiver == 0);
            CHECK(wrong_shadow == 0);
            CHECK(other_triangle < tries / 100);
            CHECK(uncertain < tries / 20);
            CHECK(dark > tries / 100);
            if (!compress) CHECK(other_shadow < tries / 500);
        }
    }
}

TEST_CASE("the share of samples in shadow is that of the reference within 4 standard errors") {
    for (const motion::Scene& scene : {motion::make_cubes(), motion::make_blinds()}) {
        INFO(scene.name);
        motion::Settings settings;
        settings.width = 80;
        settings.height = 60;
        settings.shadow_map = 256;
        settings.samples = 128;
        settings.compress = false;
        motion::Renderer renderer(device(), scene, settings);
        const auto method = motion::make_exact(renderer.frame());
        renderer.draw(*method);
        const std::vector<cl_float4> exact = renderer.picture().download();
        constexpr cl_uint moments = 128;
        motion::Accumulation accumulation(renderer.frame());
        accumulation.draw(0, moments, moments);
        const std::vector<cl_float4> reference = accumulation.picture(moments);
        REQUIRE(exact.size() == reference.size());
        std::size_t beyond = 0;
        double difference = 0, variance = 0;
        for (std::size_t i = 0; i < exact.size(); ++i) {
            const double a = double(exact[i].s[3]), b = double(reference[i].s[3]);
            // Half a sample is added on both sides, so that few samples do not seem certain.
            const double p = (0.5 * (a + b) * (settings.samples + moments) + 1) /
                             (settings.samples + moments + 2);
            const double square = p * (1 - p) * (1.0 / settings.samples + 1.0 / moments);
            if (std::abs(a - b) > 4 * std::sqrt(square)) ++beyond;
            difference += a - b;
            variance += square;
        }
        std::cout << scene.name << ": " << beyond << " pixels beyond 4 standard errors, mean "
                  << difference / std::sqrt(variance) << " standard errors\n";
        CHECK(beyond == 0);
        CHECK(std::abs(difference) <= 4 * std::sqrt(variance));
    }
}

}  // namespace
}  // namespace cellist::test
