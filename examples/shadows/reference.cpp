// SPDX-License-Identifier: MIT
#include "reference.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <thread>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "grid/embree.hpp"
#include "grid/exact.hpp"
#include "image.hpp"

namespace shadows {
namespace {

// Triangles that the CPU may ask for rays, and again for pixels: seconds, with one triangle a
// nanosecond.
constexpr double reference_work = 4e9;

// Triangles that block segments, on the CPU: by Embree if there is one, else by every triangle.
class Occluders {
public:
    explicit Occluders(std::vector<grid::GridTriangle> triangles)
        : triangles_(std::move(triangles)) {
        if (grid::has_embree() && !triangles_.empty())
            tree_ = std::make_unique<grid::EmbreeTriangles>(triangles_);
    }
    [[nodiscard]] static std::string name() {
        return grid::has_embree() ? grid::EmbreeTriangles::name() : "every triangle";
    }
    // Of a segment, in triangles.
    [[nodiscard]] double cost() const {
        constexpr double cost_of_tree = 50;
        return tree_ ? cost_of_tree : static_cast<double>(triangles_.size() + 1);
    }
    // Embree may be wrong where the segment grazes a triangle.
    [[nodiscard]] bool block(const glm::vec3& from, const glm::vec3& to) const {
        return tree_ ? tree_->meets_any(from, to) : block_exactly(from, to);
    }
    [[nodiscard]] bool block_exactly(const glm::vec3& from, const glm::vec3& to) const {
        return grid::meets_any(from, to, triangles_);
    }

private:
    std::vector<grid::GridTriangle> triangles_;
    std::unique_ptr<grid::EmbreeTriangles> tree_;
};

std::size_t step_for(double segments, const Occluders& occluders) {
    return static_cast<std::size_t>(
        std::max(1.0, std::ceil(segments * occluders.cost() / reference_work)));
}

// Calls work(i) for each i below `count`, on all threads.
void for_each_index(std::size_t count, const auto& work) {
    const std::size_t threads = std::max(1U, std::thread::hardware_concurrency());
    std::vector<std::thread> running;
    for (std::size_t t = 0; t < threads; ++t)
        running.emplace_back([&, t] {
            for (std::size_t i = t; i < count; i += threads) work(i);
        });
    for (std::thread& thread : running) thread.join();
}

glm::dvec3 vector_of(const cl_float4& v) { return {v.s[0], v.s[1], v.s[2]}; }

// See light.clh.
glm::dvec3 exact_light(const Emitter& emitter, const glm::dvec3& point, const glm::dvec3& normal) {
    const glm::dvec3 d = vector_of(emitter.position) - point;
    const double square = glm::dot(d, d);
    if (!(square > 0)) return glm::dvec3(0);
    const double leaves = std::max(-glm::dot(vector_of(emitter.normal), d), 0.0);
    const double arrives = std::max(glm::dot(normal, d), 0.0);
    return vector_of(emitter.power) *
           (leaves * arrives /
            (std::numbers::pi * square * (square + static_cast<double>(emitter.power.s[3]))));
}

std::vector<cl_float4> chosen(const std::vector<cl_float4>& image,
                              const std::vector<std::size_t>& pixels, double factor = 1) {
    std::vector<cl_float4> result;
    for (const std::size_t p : pixels) {
        cl_float4 pixel = image[p];
        for (cl_float& channel : pixel.s)
            channel = static_cast<cl_float>(factor * static_cast<double>(channel));
        result.push_back(pixel);
    }
    return result;
}

// Irradiance as a white surface shows it.
support::ImageDifference irradiance_difference(const std::vector<cl_float4>& image,
                                               const std::vector<std::size_t>& pixels,
                                               std::vector<glm::dvec3> reference, std::size_t width,
                                               std::size_t height) {
    for (glm::dvec3& pixel : reference) pixel /= std::numbers::pi;
    return support::difference(chosen(image, pixels, 1 / std::numbers::pi), reference, width,
                               height);
}

// Checks answers of the device against the CPU's.
void check_rays(const std::vector<grid::GridSegment>& segments, const std::vector<cl_uint>& blocked,
                std::size_t count, const Occluders& occluders, std::size_t step,
                Accuracy& accuracy) {
    const auto end_of = [](const cl_float4& v) { return glm::vec3(v.s[0], v.s[1], v.s[2]); };
    std::vector<char> answers((count + step - 1) / step);  // 0 equal, 1 decided, 2 wrong
    std::vector<char> lit(answers.size());  // rays to samples without light have no length
    for_each_index(answers.size(), [&](std::size_t i) {
        const grid::GridSegment& segment = segments[i * step];
        const glm::vec3 from = end_of(segment.from), to = end_of(segment.to);
        const bool is_blocked = blocked[i * step] != 0;
        lit[i] = from != to;
        if (is_blocked == (lit[i] && occluders.block(from, to))) return;
        answers[i] = is_blocked == occluders.block_exactly(from, to) ? 1 : 2;
    });
    accuracy.rays += static_cast<std::uint64_t>(std::ranges::count(lit, char{1}));
    accuracy.rays_decided += static_cast<std::uint64_t>(std::ranges::count(answers, char{1}));
    accuracy.rays_different += static_cast<std::uint64_t>(std::ranges::count(answers, char{2}));
}

void count_visible_errors(const std::vector<cl_float4>& picture, const Reference& reference,
                          Accuracy& accuracy) {
    for (std::size_t i = 0; i < reference.pixels.size(); ++i) {
        double brighter = 0, darker = 0;
        for (int channel = 0; channel < 3; ++channel) {
            const double error = support::srgb_from_linear(
                                     static_cast<double>(picture[reference.pixels[i]].s[channel])) -
                                 support::srgb_from_linear(reference.picture[i][channel]);
            brighter = std::max(brighter, error);
            darker = std::max(darker, -error);
        }
        if (brighter > Accuracy::visible) ++accuracy.leaks;
        if (darker > Accuracy::visible) ++accuracy.over_dark;
    }
}

Reference reference_with(const Renderer& renderer, const Occluders& occluders) {
    const std::vector<Surface> surfaces = renderer.surfaces().download();
    const std::vector<cl_float4> a = renderer.a().download();
    const std::vector<cl_float4> unblocked = renderer.unblocked().download();
    std::vector<Emitter> emitters = renderer.emitters().download();
    std::erase_if(emitters, [](const Emitter& emitter) { return emitter.power.s[3] == 0; });
    const auto bias = static_cast<double>(renderer.gather().bias);
    const std::size_t step = step_for(
        static_cast<double>(surfaces.size()) * static_cast<double>(emitters.size()), occluders);

    Reference reference;
    for (std::size_t p = 0; p < surfaces.size(); p += step) reference.pixels.push_back(p);
    const std::size_t count = reference.pixels.size();
    reference.a.resize(count);
    reference.b.resize(count);
    reference.picture.resize(count);
    for_each_index(count, [&](std::size_t i) {
        const std::size_t p = reference.pixels[i];
        const Surface& surface = surfaces[p];
        if (surface.position.s[3] == 0) return;
        const glm::dvec3 point = vector_of(surface.position), normal = vector_of(surface.normal);
        const glm::vec3 from(point + bias * normal);
        for (const Emitter& emitter : emitters) {
            const glm::dvec3 light = exact_light(emitter, point, normal);
            if (light == glm::dvec3(0)) continue;
            reference.a[i] += light;
            const glm::vec3 to(vector_of(emitter.position) +
                               static_cast<double>(emitter.normal.s[3]) *
                                   vector_of(emitter.normal));
            if (occluders.block(from, to)) reference.b[i] += light;
        }
        const glm::dvec3 reflected = vector_of(surface.albedo) / std::numbers::pi;
        reference.picture[i] =
            vector_of(unblocked[p]) +
            reflected * (glm::max(reference.a[i] - reference.b[i], 0.0) - vector_of(a[p]));
    });
    return reference;
}

}  // namespace

Reference make_reference(const Renderer& renderer) {
    return reference_with(renderer, Occluders(renderer.grid().triangles().download()));
}

Accuracy compare_with_reference(Renderer& renderer, const Scene& scene) {
    const Gather& gather = renderer.gather();
    Accuracy accuracy;
    accuracy.visibility = Occluders::name();
    std::optional<Occluders> occluders;
    std::size_t step = 1;
    renderer.draw(
        scene, nullptr, [&](const auto& segments, std::size_t count, const auto& blocked) {
            if (!occluders) {
                occluders.emplace(renderer.grid().triangles().download());
                step = step_for(static_cast<double>(renderer.rays_in_frame()), *occluders);
            }
            check_rays(segments.download(), blocked.download(), count, *occluders, step, accuracy);
        });

    const Reference reference = reference_with(renderer, *occluders);
    accuracy.pixels = reference.pixels.size();
    accuracy.all_pixels = accuracy.pixels == renderer.a().size();
    const auto width =
        accuracy.all_pixels ? static_cast<std::size_t>(gather.width) : reference.pixels.size();
    const std::size_t height = reference.pixels.size() / width;
    const std::vector<cl_float4> picture = renderer.picture().download();
    accuracy.picture =
        support::difference(chosen(picture, reference.pixels), reference.picture, width, height);
    accuracy.a = irradiance_difference(renderer.a().download(), reference.pixels, reference.a,
                                       width, height);
    accuracy.b = irradiance_difference(renderer.blurred_b().download(), reference.pixels,
                                       reference.b, width, height);
    count_visible_errors(picture, reference, accuracy);
    return accuracy;
}

}  // namespace shadows
