// SPDX-License-Identifier: MIT
#include "frame/frame_features.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

namespace oit {
namespace {

// Around the axis about which an instance turns, so that it holds at any time.
struct Ball {
    glm::dvec3 centre;
    double radius;
};

Ball ball_around(const Scene& scene, const Instance& instance) {
    double radius = 0;
    for (const glm::vec3& p : scene.models.at(instance.model).mesh.positions)
        radius = std::max(radius, glm::length(glm::dvec3(p)));
    double scale = 0;
    for (int i = 0; i < 3; ++i)
        scale = std::max(scale, glm::length(glm::dvec3(instance.to_world[i])));
    return {glm::dvec3(instance.to_world[3]), scale * radius};
}

void widen_depths(FrameFeatures& features, const Ball& ball, const raster::View& view) {
    const auto at = [&](int i) { return static_cast<double>(view.row_w[i]); };
    const double depth =
        at(0) * ball.centre.x + at(1) * ball.centre.y + at(2) * ball.centre.z + at(3);
    const double reach = ball.radius * glm::length(glm::dvec3(at(0), at(1), at(2)));
    constexpr double room = 1e-5;  // for rounding
    features.least_depth =
        std::min(features.least_depth, static_cast<float>((depth - reach) * (1 - room)));
    features.greatest_depth =
        std::max(features.greatest_depth, static_cast<float>((depth + reach) * (1 + room)));
}

// A bound of what shading.clh computes.
float brightest(const Material& material, const Lighting& lighting) {
    float most = 1;
    for (int i = 0; i < 3; ++i) {
        const float ambient = std::max(lighting.sky[i], lighting.ground[i]);
        const float tint = std::max(material.front_tint[i], material.back_tint[i]);
        most = std::max(most, tint * (ambient + lighting.key[i]) +
                                  material.gloss * lighting.key[i] + lighting.rim[i]);
    }
    return most;
}

// Of the samples, in pixels from the centre.
std::string offsets_text(int samples) {
    std::string text;
    for (const raster::SampleOffset& offset : raster::sample_offsets(samples)) {
        const auto part = [](int i) {
            return std::to_string(i * RASTER_OFFSET_UNIT) + ".0f / " +
                   std::to_string(RASTER_SUBPIXELS) + ".0f";
        };
        text += (text.empty() ? "(float2)(" : ", (float2)(") + part(offset.x) + ", " +
                part(offset.y) + ")";
    }
    return text;
}

}  // namespace

bool FrameFeatures::blend_varies() const { return std::popcount(blends) > 1 || has(Blend::absorb); }

FrameFeatures features_of(const Frame& frame) {
    const Scene& scene = frame.scene;
    FrameFeatures features;
    features.least_depth = std::numeric_limits<float>::max();
    bool first = true;
    for (const Instance& instance : scene.instances) {
        features.tints = features.tints || !scene.models.at(instance.model).tints.empty();
        const bool is_opaque = scene.is_opaque(instance);
        if (is_opaque && !frame.stores_opaque()) {
            features.opaque = true;
            continue;
        }
        const Material& material = scene.material_of(instance);
        const auto blend = is_opaque ? Blend::over : static_cast<Blend>(material.blend);
        const float alpha = is_opaque ? 1 : material.alpha;
        features.stores_opaque = features.stores_opaque || is_opaque ||
                                 (frame.stores_opaque() && blend == Blend::over && alpha == 1);
        features.blends |= 1U << static_cast<std::uint32_t>(blend);
        features.opacities = features.opacities ||
                             (!is_opaque && !scene.models.at(instance.model).opacities.empty());
        features.has_highlights =
            features.has_highlights || (blend == Blend::absorb && material.gloss > 0);
        features.alpha_varies = features.alpha_varies || (!first && alpha != features.alpha);
        features.alpha = alpha;
        first = false;
        features.colour_max = std::max(features.colour_max, brightest(material, scene.lighting));
        for (const raster::View& view : frame.views)
            widen_depths(features, ball_around(scene, instance), view);
    }
    features.alpha_varies = features.alpha_varies || features.opacities;
    if (features.has_highlights)
        features.blends |= 1U << static_cast<std::uint32_t>(Blend::additive);
    features.least_depth = std::max(features.least_depth, frame.views.front().near_depth);
    // Also where nothing is in front of the eye.
    features.greatest_depth = std::max(features.greatest_depth, 2 * frame.views.front().near_depth);
    features.least_depth = std::min(features.least_depth, 0.5F * features.greatest_depth);
    return features;
}

std::uint32_t state_floats(const Quality& quality, const FrameFeatures& features) {
    const std::uint32_t transmittance = features.transmittance_is_coloured() ? 3 : 1;
    const std::uint32_t depth = features.has(Blend::absorb) || features.has(Blend::user) ? 1 : 0;
    const std::uint32_t extinction = features.has(Blend::absorb) ? 3 : 0;
    const auto samples =
        quality.resolve == Resolve::per_sample ? 1 : static_cast<std::uint32_t>(quality.samples);
    return samples * (3 + transmittance + depth + extinction);
}

std::string define(const std::string& name, const std::string& value) {
    return "#define " + name + " " + value + "\n";
}

std::string defines_of(const Frame& frame, const FrameFeatures& features) {
    const Quality& quality = frame.quality;
    std::string text;
    constexpr const char* names[] = {"OPAQUE", "OVER", "ADDITIVE", "MULTIPLICATIVE",
                                     "ABSORB", "USER", "LEAVE"};
    for (std::uint32_t i = 0; i < std::size(names); ++i)
        text += define(std::string("OIT_") + names[i], i);
    text += define("OIT_FLOOR", static_cast<std::uint32_t>(Paint::floor));
    text += define("OIT_BLENDS", features.blends);
    if (!features.blend_varies())
        text +=
            define("OIT_ONLY_BLEND", features.blends == 0 ? 1 : std::countr_zero(features.blends));
    text += define("OIT_SAMPLES", quality.samples);
    text += define("OIT_STATE_FLOATS", state_floats(quality, features));
    if (features.opaque) text += "#define OIT_HAS_OPAQUE\n";
    if (features.stores_opaque) text += "#define OIT_STORES_OPAQUE\n";
    if (features.opacities) text += "#define OIT_HAS_OPACITIES\n";
    if (features.tints) text += "#define OIT_HAS_TINTS\n";
    if (features.has(Blend::absorb)) text += "#define OIT_ABSORBS\n";
    if (features.has(Blend::absorb) || features.has(Blend::user))
        text += "#define OIT_NEEDS_DISTANCE\n";
    if (features.has(Blend::user)) text += "#define OIT_USER_BLEND\n";
    if (features.transmittance_is_coloured()) text += "#define OIT_COLOURED\n";
    if (quality.resolve == Resolve::per_sample && quality.samples > 1)
        text += "#define OIT_PER_SAMPLE\n";
    if (quality.depth_range)
        text += "#define OIT_DEPTH_RANGE\n" + define("OIT_OFFSETS", offsets_text(quality.samples));
    if (quality.coverage == Coverage::exact) text += "#define OIT_EXACT\n";
    if (quality.epsilon > 0) text += "#define OIT_EARLY_END\n";
    if (quality.reduce > 1) text += "#define OIT_REDUCED\n";
    if (frame.memory_bytes) text += "#define OIT_SLICES\n";
    return text;
}

}  // namespace oit
