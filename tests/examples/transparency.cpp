// SPDX-License-Identifier: MIT
// The example `transparency` draws what rays against all triangles see, in double precision.
#include "transparency.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <random>
#include <vector>

#include <glm/geometric.hpp>

#include "camera.hpp"
#include "support/catch.hpp"
#include "support/device.hpp"

namespace cellist::test {
namespace {

using glm::dvec3;

/// A closed tube that winds through itself: many layers, of which some cross.
support::Mesh tube(int along, int around) {
    constexpr double turn = 6.283185307179586;
    support::Mesh mesh;
    for (int i = 0; i < along; ++i)
        for (int j = 0; j < around; ++j) {
            const double t = turn * i / along, a = turn * j / around;
            const double r = 0.62 + 0.3 * std::cos(3 * t) + 0.2 * std::cos(a);
            mesh.positions.emplace_back(r * std::cos(2 * t), r * std::sin(2 * t),
                                        0.25 * std::sin(3 * t) + 0.2 * std::sin(a));
            mesh.normals.emplace_back(0);
        }
    const auto vertex = [&](int i, int j) {
        return static_cast<std::uint32_t>(i % along * around + j % around);
    };
    for (int i = 0; i < along; ++i)
        for (int j = 0; j < around; ++j) {
            mesh.triangles.push_back({vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1)});
            mesh.triangles.push_back({vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1)});
        }
    return support::clean_mesh(mesh);
}

/// Rays against all triangles, without anything of the rasteriser but the rays of its view.
class Reference {
public:
    Reference(const support::Mesh& mesh, const raster::View& view,
              const transparency::Surface& surface)
        : mesh_(mesh), view_(view), surface_(surface) {}

    /// The colour at a place in the image, in pixels; (0, 0) is the centre of the first.
    [[nodiscard]] dvec3 colour(double x, double y) const {
        const dvec3 ray = glm::normalize(vector(view_.ray_origin) + x * vector(view_.ray_x) +
                                         y * vector(view_.ray_y));
        std::vector<Hit> hits;
        for (const auto& triangle : mesh_.triangles)
            if (const auto hit = meet(triangle, vector(view_.eye), ray)) hits.push_back(*hit);
        std::ranges::sort(hits, {}, &Hit::distance);
        dvec3 colour(0);
        double transmittance = 1;
        for (const Hit& hit : hits) {
            const double alpha = alpha_of(hit.normal, ray);
            colour += transmittance * alpha * shade(hit.normal, ray);
            transmittance *= 1 - alpha;
        }
        return colour + transmittance * dvec3(surface_.background);
    }

private:
    struct Hit {
        double distance;
        dvec3 normal;
    };

    static dvec3 vector(const cl_float (&v)[3]) { return {v[0], v[1], v[2]}; }

    /// By the signed volumes that the ray spans with the edges.
    [[nodiscard]] std::optional<Hit> meet(const std::array<std::uint32_t, 3>& triangle,
                                          const dvec3& eye, const dvec3& ray) const {
        dvec3 corner[3];
        for (std::size_t i = 0; i < 3; ++i) corner[i] = dvec3(mesh_.positions[triangle[i]]) - eye;
        double share[3], sum = 0;
        for (std::size_t i = 0; i < 3; ++i)
            sum += share[i] = glm::dot(ray, glm::cross(corner[(i + 1) % 3], corner[(i + 2) % 3]));
        if (sum == 0) return {};
        Hit hit{0, dvec3(0)};
        for (std::size_t i = 0; i < 3; ++i) {
            const double part = share[i] / sum;
            if (part < 0) return {};
            hit.distance += part * glm::dot(corner[i], ray);
            hit.normal += part * dvec3(mesh_.normals[triangle[i]]);
        }
        if (hit.distance <= 0) return {};
        hit.normal = glm::normalize(hit.normal);
        return hit;
    }

    [[nodiscard]] double alpha_of(const dvec3& normal, const dvec3& ray) const {
        const double facing = std::max(std::abs(glm::dot(normal, ray)), 0.2);
        return 1 - std::pow(1 - static_cast<double>(surface_.alpha), 1 / facing);
    }

    [[nodiscard]] dvec3 shade(const dvec3& normal, const dvec3& ray) const {
        const dvec3 light(surface_.light);
        const double diffuse = 0.2 + 0.8 * std::abs(glm::dot(normal, light));
        const double cosine = std::abs(glm::dot(normal, glm::normalize(light - ray)));
        return diffuse * dvec3(surface_.colour) + 0.6 * std::pow(cosine, 64);
    }

    const support::Mesh& mesh_;
    const raster::View& view_;
    const transparency::Surface& surface_;
};

double difference(const cl_float4& pixel, const dvec3& expected) {
    double most = 0;
    for (int i = 0; i < 3; ++i)
        most = std::max(most, std::abs(static_cast<double>(pixel.s[i]) - expected[i]));
    return most;
}

/// The rasteriser rounds corners to 1/256 pixel, so a pixel at an edge may see what a ray beside
/// its own sees. Returns the number of pixels that are neither.
int wrong_pixels(const transparency::Picture& picture, const Reference& reference, int width) {
    constexpr double tolerance = 2e-4, beside = 1.0 / 256;
    int wrong = 0;
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
        const double x = static_cast<double>(i % static_cast<std::size_t>(width));
        const double y = static_cast<double>(i / static_cast<std::size_t>(width));
        const auto is_near = [&](double dx, double dy) {
            return difference(picture.pixels[i], reference.colour(x + dx, y + dy)) <
                   (dx == 0 && dy == 0 ? tolerance : 10 * tolerance);
        };
        bool good = is_near(0, 0);
        for (int n = 0; n < 9 && !good; ++n)
            good = is_near(beside * (n % 3 - 1), beside * (n / 3 - 1));
        wrong += good ? 0 : 1;
    }
    return wrong;
}

TEST_CASE("the picture is that of rays, whatever the order of the triangles") {
    support::Mesh mesh = tube(90, 24);
    support::fit_to_unit_sphere(mesh);
    constexpr int width = 96, height = 72;
    const raster::View view = support::frame_unit_sphere({30, 20}, width, height);
    for (const float alpha : {0.3F, 0.85F}) {
        transparency::Surface surface;
        surface.alpha = alpha;
        INFO("alpha " << alpha);
        const transparency::Picture picture = transparency::draw(device(), mesh, view, surface);
        REQUIRE(picture.pixels.size() == std::size_t{width} * height);
        CHECK(picture.layers.longest >= 6);
        CHECK(wrong_pixels(picture, Reference(mesh, view, surface), width) == 0);

        std::mt19937 random(7);
        support::Mesh shuffled = mesh;
        std::shuffle(shuffled.triangles.begin(), shuffled.triangles.end(), random);
        const transparency::Picture again = transparency::draw(device(), shuffled, view, surface);
        bool equal = true;
        for (std::size_t i = 0; i < picture.pixels.size(); ++i)
            for (int c = 0; c < 3; ++c)
                equal = equal && picture.pixels[i].s[c] == again.pixels[i].s[c];
        CHECK(equal);
    }
}

TEST_CASE("without a surface in a pixel, it shows the background") {
    support::Mesh mesh;
    mesh.positions = {{0, 0, 0}, {0.1F, 0, 0}, {0, 0.1F, 0}};
    mesh.normals.assign(3, {0, 0, 1});
    mesh.triangles = {{0, 1, 2}};
    const transparency::Surface surface;
    const transparency::Picture picture =
        transparency::draw(device(), mesh, support::frame_unit_sphere({}, 40, 40), surface);
    CHECK(difference(picture.pixels[0], dvec3(surface.background)) == 0);
    CHECK(picture.layers.longest == 1);
    CHECK(picture.layers.histogram.at(0) == 1600 - picture.layers.total);
}

}  // namespace
}  // namespace cellist::test
