// SPDX-License-Identifier: MIT
#include "reference/reference.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <tuple>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "frame/node_layout.hpp"
#include "input_error.hpp"
#include "reference/blend.hpp"
#include "reference/raster.hpp"
#include "reference/shading.hpp"

namespace oit {
namespace {

using glm::dvec3;

constexpr double infinity = std::numeric_limits<double>::infinity();

// Whether the order of two fragments at nearly the same depth matters, where both are blended. A
// medium of no thickness does nothing, sums and products can be taken in any order, and two
// surfaces that cover change the picture by no more than the difference of what they add.
bool order_matters(const ReferenceFragment& a, const ReferenceFragment& b) {
    if (a.blend == Blend::absorb || b.blend == Blend::absorb) return false;
    constexpr double visible = 1e-7;
    if (a.blend == Blend::over && b.blend == Blend::over) return swap_error(a, b) > visible;
    return a.blend != b.blend || (a.blend != Blend::additive && a.blend != Blend::multiplicative);
}

// The nearest opaque surface of a sample.
struct OpaqueSample {
    double depth = infinity;
    dvec3 colour{0.0};
};

class ReferenceRenderer {
public:
    ReferenceRenderer(const Frame& frame, const ReferenceOptions& options)
        : frame_(frame),
          options_(options),
          features_(features_of(frame)),
          layout_(node_layout(frame.quality, features_)),
          samples_(static_cast<std::size_t>(frame.quality.samples)),
          opaque_(frame.pixels() * samples_) {
        reference_.width = static_cast<std::size_t>(frame.width());
        reference_.height = static_cast<std::size_t>(frame.height());
        reference_.ambiguous.assign(frame.pixels(), false);
        reference_.image.resize(frame.pixels());
        for (const Instance& instance : frame.scene.instances)
            triangles_ += frame.views.size() * model_of(instance).mesh.triangles.size();
    }

    Reference draw() {
        for_each_instance(true, [&](auto&&... arguments) { cover_opaque(arguments...); });
        for_each_instance(false, [&](auto&&... arguments) { cover_transparent(arguments...); });
        sort_into_pixels();
        for (std::size_t p = 0; p < frame_.pixels(); ++p) blend(p);
        return std::move(reference_);
    }

private:
    [[nodiscard]] const Model& model_of(const Instance& instance) const {
        return frame_.scene.models.at(instance.model);
    }

    // Calls use(eye, instance, placed, triangle, cover) for the pixels that the opaque or the other
    // instances cover.
    template <class Use>
    void for_each_instance(bool opaque, const Use& use) {
        for (std::size_t eye = 0; eye < frame_.views.size(); ++eye)
            for (const Instance& instance : frame_.scene.instances) {
                if (frame_.scene.is_opaque(instance) != opaque) continue;
                const support::Mesh& mesh = model_of(instance).mesh;
                const Projection<float> placed(transform_at(instance, frame_.time),
                                               frame_.views[eye]);
                std::size_t last = 0;
                for_each_cover(mesh, placed, frame_.quality.samples,
                               [&](std::size_t triangle, const ReferenceCover& cover) {
                                   if (triangle / 1024 != last / 1024) report(done_ + triangle);
                                   last = triangle;
                                   use(eye, instance, placed, triangle, cover);
                               });
                done_ += mesh.triangles.size();
            }
    }

    // Whether nodes may have two depths in the wrong order.
    [[nodiscard]] bool too_close(double a, double b) const {
        // Infinity is the depth of no surface, which is close to nothing.
        return std::isfinite(a) && std::isfinite(b) &&
               std::abs(a - b) <= layout_.depth_resolution(features_).at(std::max(a, b));
    }
    // The same for depths that are compared before they are stored.
    [[nodiscard]] static bool float_too_close(double a, double b) {
        return std::isfinite(a) && std::isfinite(b) &&
               std::abs(a - b) <= depth_resolution * std::max(a, b);
    }

    void report(std::size_t triangles) const {
        if (options_.progress)
            options_.progress(static_cast<double>(triangles) / static_cast<double>(triangles_));
    }

    [[nodiscard]] std::size_t pixel_of(std::size_t eye, int x, int y) const {
        return (eye * static_cast<std::size_t>(frame_.height()) + static_cast<std::size_t>(y)) *
                   static_cast<std::size_t>(frame_.width()) +
               static_cast<std::size_t>(x);
    }

    [[nodiscard]] dvec3 normal_of(const Instance& instance, const Projection<float>& placed,
                                  std::size_t triangle, const ReferenceCover& cover) const {
        const support::Mesh& mesh = model_of(instance).mesh;
        dvec3 normal(0);
        for (std::size_t j = 0; j < 3; ++j)
            normal += cover.weight[j] * dvec3(mesh.normals[mesh.triangles[triangle][j]]);
        return placed.normal(normal);
    }

    // The tint of the side that is seen.
    [[nodiscard]] dvec3 tint_of(const Instance& instance, std::size_t triangle,
                                const ReferenceCover& cover) const {
        const Material& material = frame_.scene.material_of(instance);
        const Model& model = model_of(instance);
        const dvec3 tint = to_double(cover.front ? material.front_tint : material.back_tint);
        if (model.tints.empty()) return tint;
        dvec3 factor(0);
        for (std::size_t j = 0; j < 3; ++j)
            factor += cover.weight[j] * dvec3(model.tints[model.mesh.triangles[triangle][j]]);
        return tint * factor;
    }

    void cover_opaque(std::size_t eye, const Instance& instance, const Projection<float>& placed,
                      std::size_t triangle, const ReferenceCover& cover) {
        const Material& material = frame_.scene.material_of(instance);
        const ReferenceShading shading(frame_.scene.lighting, frame_.views[eye]);
        const std::size_t pixel = pixel_of(eye, cover.x, cover.y);
        const bool is_floor = material.paint == static_cast<cl_uint>(Paint::floor);
        const dvec3 colour = is_floor
                                 ? shading.floor(cover.x, cover.y)
                                 : shading.surface(tint_of(instance, triangle, cover),
                                                   static_cast<double>(material.gloss),
                                                   normal_of(instance, placed, triangle, cover),
                                                   cover.front, cover.x, cover.y);
        for (std::size_t s = 0; s < samples_; ++s) {
            if ((cover.coverage >> s & 1) == 0) continue;
            OpaqueSample& sample = opaque_[pixel * samples_ + s];
            if (float_too_close(sample.depth, cover.depth) && colour != sample.colour)
                reference_.ambiguous[pixel] = true;
            if (cover.depth < sample.depth) sample = {cover.depth, colour};
        }
    }

    void cover_transparent(std::size_t eye, const Instance& instance,
                           const Projection<float>& placed, std::size_t triangle,
                           const ReferenceCover& cover) {
        const std::size_t pixel = pixel_of(eye, cover.x, cover.y);
        std::uint32_t visible = 0;
        for (std::size_t s = 0; s < samples_; ++s) {
            if ((cover.coverage >> s & 1) == 0) continue;
            const double behind = opaque_[pixel * samples_ + s].depth;
            if (float_too_close(cover.depth, behind)) reference_.ambiguous[pixel] = true;
            if (cover.depth < behind) visible |= 1U << s;
        }
        if (visible == 0) return;

        const Material& material = frame_.scene.material_of(instance);
        const ReferenceShading shading(frame_.scene.lighting, frame_.views[eye]);
        const auto blend = static_cast<Blend>(material.blend);
        const auto gloss = static_cast<double>(material.gloss);
        dvec3 tint = tint_of(instance, triangle, cover);
        ReferenceFragment fragment{cover.depth,
                                   tint,
                                   alpha_of(instance, triangle, cover),
                                   blend,
                                   !cover.front,
                                   visible,
                                   cover.sample_depth};
        if (frame_.quality.depth_range) fragment.depth = mean_depth(fragment);
        if (blend == Blend::absorb) {
            fragment.colour = glm::mix(dvec3(1), to_double(material.front_tint),
                                       static_cast<double>(material.alpha));
            add(pixel, fragment);
            if (gloss == 0 || !cover.front) return;
            fragment.blend = Blend::additive;
            tint = dvec3(0);
        }
        if (blend != Blend::multiplicative)
            fragment.colour =
                shading.surface(tint, gloss, normal_of(instance, placed, triangle, cover),
                                cover.front, cover.x, cover.y);
        add(pixel, fragment);
    }

    // At the mean of the samples that are visible: 1 / depth is linear in the image.
    [[nodiscard]] double mean_depth(const ReferenceFragment& fragment) const {
        double sum = 0;
        for (std::size_t s = 0; s < samples_; ++s)
            if ((fragment.coverage >> s & 1) != 0) sum += 1 / fragment.sample_depth[s];
        return std::popcount(fragment.coverage) / sum;
    }

    [[nodiscard]] double alpha_of(const Instance& instance, std::size_t triangle,
                                  const ReferenceCover& cover) const {
        const auto alpha = static_cast<double>(frame_.scene.material_of(instance).alpha);
        const Model& model = model_of(instance);
        if (model.opacities.empty()) return alpha;
        double opacity = 0;
        for (std::size_t j = 0; j < 3; ++j)
            opacity += cover.weight[j] *
                       static_cast<double>(model.opacities[model.mesh.triangles[triangle][j]]);
        return alpha * opacity;
    }

    void add(std::size_t pixel, const ReferenceFragment& fragment) {
        unordered_.emplace_back(pixel, fragment);
    }

    void sort_into_pixels() {
        reference_.offsets.assign(frame_.pixels() + 1, 0);
        for (const auto& [pixel, fragment] : unordered_) ++reference_.offsets[pixel + 1];
        for (std::size_t p = 0; p < frame_.pixels(); ++p)
            reference_.offsets[p + 1] += reference_.offsets[p];
        reference_.fragments.resize(unordered_.size());
        std::vector<std::uint64_t> next(reference_.offsets.begin(), reference_.offsets.end() - 1);
        for (const auto& [pixel, fragment] : unordered_)
            reference_.fragments[next[pixel]++] = fragment;
    }

    // The fragments that cover a sample, nearest first.
    [[nodiscard]] std::vector<const ReferenceFragment*> order_in(
        std::size_t p, std::span<const ReferenceFragment> list, std::size_t s) {
        std::vector<const ReferenceFragment*> order;
        for (const ReferenceFragment& fragment : list)
            if ((fragment.coverage >> s & 1) != 0) order.push_back(&fragment);
        if (!frame_.quality.depth_range) return order;
        std::ranges::stable_sort(order, {}, [&](const ReferenceFragment* fragment) {
            return fragment->sample_depth[s];
        });
        for (std::size_t i = 0; i + 1 < order.size(); ++i)
            for (std::size_t j = i + 1;
                 j < order.size() && slopes_too_close(*order[i], *order[j], s); ++j)
                if (order_matters(*order[i], *order[j])) reference_.ambiguous[p] = true;
        return order;
    }

    // Whether depths in a sample may have the wrong order for the slopes that nodes hold as halves.
    [[nodiscard]] bool slopes_too_close(const ReferenceFragment& a, const ReferenceFragment& b,
                                        std::size_t s) const {
        constexpr double half = 0x1p-10;
        const double steep =
            std::abs(a.sample_depth[s] - a.depth) + std::abs(b.sample_depth[s] - b.depth);
        const double most = std::max(a.sample_depth[s], b.sample_depth[s]);
        return std::abs(a.sample_depth[s] - b.sample_depth[s]) <=
               layout_.depth_resolution(features_).at(most) + half * steep;
    }

    void blend(std::size_t p) {
        const auto width = static_cast<std::size_t>(frame_.width());
        const auto height = static_cast<std::size_t>(frame_.height());
        const std::size_t eye = p / (width * height);
        const auto x = static_cast<int>(p % width), y = static_cast<int>(p / width % height);
        const ReferenceShading shading(frame_.scene.lighting, frame_.views[eye]);

        const std::span<ReferenceFragment> list(
            reference_.fragments.begin() + static_cast<std::ptrdiff_t>(reference_.offsets[p]),
            reference_.fragments.begin() + static_cast<std::ptrdiff_t>(reference_.offsets[p + 1]));
        std::sort(list.begin(), list.end(),
                  [](const ReferenceFragment& a, const ReferenceFragment& b) {
                      return std::tie(a.depth, a.colour.x, a.colour.y, a.colour.z) <
                             std::tie(b.depth, b.colour.x, b.colour.y, b.colour.z);
                  });
        const std::size_t layers =
            std::min<std::size_t>(list.size(), frame_.quality.layers.value_or(~0U));
        for (std::size_t i = 0; i < layers; ++i)
            for (std::size_t j = i + 1; j < list.size() && too_close(list[i].depth, list[j].depth);
                 ++j)
                if (j >= layers || order_matters(list[i], list[j])) reference_.ambiguous[p] = true;

        std::vector<ReferenceLight> lights(
            samples_, ReferenceLight(glm::length(shading.ray(x, y)), options_));
        for (std::size_t s = 0; s < samples_; ++s)
            for (const ReferenceFragment* fragment : order_in(p, list.first(layers), s))
                lights[s].add(*fragment);
        dvec3 sum(0);
        for (std::size_t s = 0; s < samples_; ++s) {
            const OpaqueSample& behind = opaque_[p * samples_ + s];
            sum += lights[s].end(std::isinf(behind.depth) ? shading.background(y) : behind.colour,
                                 behind.depth);
        }
        reference_.image[p] = sum / static_cast<double>(samples_);
    }

    const Frame& frame_;
    const ReferenceOptions& options_;
    FrameFeatures features_;
    NodeLayout layout_;
    std::size_t samples_;
    std::vector<OpaqueSample> opaque_;
    std::vector<std::pair<std::size_t, ReferenceFragment>> unordered_;
    Reference reference_;
    std::size_t triangles_ = 0;
    std::size_t done_ = 0;
};

}  // namespace

double swap_error(const ReferenceFragment& a, const ReferenceFragment& b) {
    const dvec3 difference = glm::abs(a.colour - b.colour);
    return a.alpha * b.alpha * std::max({difference.x, difference.y, difference.z});
}

std::vector<std::uint32_t> Reference::layers() const {
    std::vector<std::uint32_t> counts;
    for (std::size_t p = 0; p + 1 < offsets.size(); ++p)
        counts.push_back(static_cast<std::uint32_t>(offsets[p + 1] - offsets[p]));
    return counts;
}

std::uint64_t Reference::most_layers() const {
    std::uint64_t most = 0;
    for (const std::uint32_t count : layers()) most = std::max<std::uint64_t>(most, count);
    return most;
}

Reference draw_reference(const Frame& frame, const ReferenceOptions& options) {
    if (features_of(frame).has(Blend::user) && !options.blend)
        throw support::InputError("a blend function in OpenCL C has no reference to compare with");
    return ReferenceRenderer(frame, options).draw();
}

}  // namespace oit
