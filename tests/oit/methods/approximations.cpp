// SPDX-License-Identifier: MIT
// Every approximation draws what its paper defines.
#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "camera.hpp"
#include "methods/renderer.hpp"
#include "oit/support/definitions.hpp"
#include "scene/scene.hpp"
#include "support/catch.hpp"
#include "support/device.hpp"

namespace cellist::test {
namespace {

struct Sheet {
    float alpha;
    double z;
    float brightness = 1;
};

// Squares that face the eye, of different colours; the nearest has the greatest z.
oit::Scene scene_of(const std::vector<Sheet>& sheets, bool one_colour = false) {
    oit::Scene scene;
    support::Mesh square;
    square.positions = {{-0.5F, -0.5F, 0}, {0.5F, -0.5F, 0}, {0.5F, 0.5F, 0}, {-0.5F, 0.5F, 0}};
    square.normals.assign(4, {0, 0, 1});
    square.triangles = {{0, 1, 2}, {0, 2, 3}};
    scene.models.push_back({.mesh = square});
    for (std::size_t i = 0; i < sheets.size(); ++i) {
        oit::Material material = oit::glass(sheets[i].alpha);
        if (!one_colour)
            for (std::size_t c = 0; c < 3; ++c)
                material.front_tint[c] =
                    sheets[i].brightness * (0.1F + 0.13F * static_cast<float>((i + 3 * c) % 7));
        scene.materials.push_back(material);
        oit::Instance instance{.material = i};
        instance.to_world[3] = glm::dvec4(0, 0, sheets[i].z, 1);
        scene.instances.push_back(instance);
    }
    return scene;
}

std::vector<Sheet> stack(std::size_t count, float alpha, double step, float brightness = 1) {
    std::vector<Sheet> sheets;
    for (std::size_t i = 0; i < count; ++i)
        sheets.push_back({alpha, 0.8 - step * static_cast<double>(i), brightness});
    return sheets;
}

oit::Frame sheets_frame(const oit::Scene& scene, std::optional<std::uint32_t> size = {}) {
    return {.scene = scene,
            .views = {support::frame_unit_sphere({0, 0}, 24, 18)},
            .quality = {.size = size}};
}

// The largest and the mean difference of a channel, as parts of the brightest that there can be.
struct Difference {
    double largest = 0;
    double mean = 0;
};

using Definition = std::function<defined::Light(defined::Layers, const defined::DepthBounds&)>;

Difference difference_from(const Definition& definition, const oit::Frame& frame,
                           const char* method) {
    oit::Renderer renderer(device(), frame, oit::method_named(method));
    renderer.draw();
    const std::vector<cl_float4> image = renderer.image();
    const oit::Reference reference = oit::draw_reference(frame);
    const oit::FrameFeatures& features = renderer.features();
    const defined::DepthBounds bounds{static_cast<double>(features.least_depth),
                                      static_cast<double>(features.greatest_depth)};
    const auto width = static_cast<std::size_t>(frame.width());
    Difference difference;
    glm::dvec3 sum(0);
    std::size_t pixels = 0;
    for (std::size_t p = 0; p < image.size(); ++p) {
        const defined::Layers layers(reference.fragments.data() + reference.offsets[p],
                                     reference.offsets[p + 1] - reference.offsets[p]);
        if (layers.empty()) continue;
        const defined::Light light = definition(layers, bounds);
        // Nothing covers the first pixel of a row, and the background does not change within one.
        const glm::dvec3 expected =
            light.colour + light.transmittance * reference.image[p / width * width];
        const glm::dvec3 off =
            (glm::dvec3(image[p].s[0], image[p].s[1], image[p].s[2]) - expected) /
            static_cast<double>(features.colour_max);
        for (int c = 0; c < 3; ++c)
            // NaN counts as far off.
            difference.largest =
                std::max(difference.largest, std::isfinite(off[c]) ? std::abs(off[c]) : 1e30);
        sum += off;
        ++pixels;
    }
    REQUIRE(pixels > 50);
    for (int c = 0; c < 3; ++c)
        difference.mean = std::max(difference.mean, std::abs(sum[c]) / static_cast<double>(pixels));
    return difference;
}

struct SheetsCase {
    const char* name;
    std::vector<Sheet> sheets;
};

std::vector<SheetsCase> cases() {
    std::vector<Sheet> bright = stack(100, 0.3F, 0.012, 1e4F);
    for (std::size_t i = 0; i < bright.size(); i += 2) bright[i].brightness = 1;
    return {{"one layer", stack(1, 0.35F, 0)},
            {"one layer of opacity 1", stack(1, 1, 0)},
            {"opacity 1 between others", {{0.5F, 0.6}, {1, 0}, {0.3F, -0.6}}},
            {"opacity 0 in front and behind", {{0, 0.6}, {0.5F, 0.3}, {1, -0.2}, {0, -0.6}}},
            {"a layer of hardly any opacity before opaque ones",
             {{0x1p-24F, 0.8}, {1, 0.4}, {1, 0}, {1, -0.4}, {1, -0.8}}},
            {"layers in one place", stack(5, 0.5F, 0)},
            {"opaque layers in one place", stack(8, 1, 0)},
            {"layers in one place between others",
             {{0.2F, 0.5}, {0.5F, 0}, {0.4F, 0}, {0.3F, 0}, {0.6F, -0.5}, {0.5F, -0.5}}},
            {"200 layers", stack(200, 0.02F, 0.008)},
            {"100 layers of opacity 0.999", stack(100, 0.999F, 0.016)},
            {"200 layers of opacity 1", stack(200, 1, 0.008)},
            {"100 layers, every second one bright", bright}};
}

void require_defined(const char* method, std::optional<std::uint32_t> size,
                     const Definition& definition, double tolerance) {
    for (const SheetsCase& of : cases()) {
        const oit::Scene scene = scene_of(of.sheets);
        const Difference difference =
            difference_from(definition, sheets_frame(scene, size), method);
        INFO(method << ", " << of.name);
        CHECK(difference.largest < (of.sheets.size() == 1 ? 2e-5 : tolerance));
    }
}

TEST_CASE("a weighted mean has the weights of McGuire and Bavoil") {
    require_defined("weighted", {}, defined::weighted, 2e-5);
}

TEST_CASE("moments let the light pass that Muenstermann et al. reconstruct") {
    require_defined("moments", {}, defined::moments, 1e-2);
}

TEST_CASE("adaptive transparency has the steps of Salvi et al.") {
    constexpr std::uint32_t steps = 4;
    require_defined(
        "adaptive", steps,
        [](defined::Layers layers, const defined::DepthBounds&) {
            return defined::adaptive(layers, steps);
        },
        2e-5);
}

TEST_CASE("a k-buffer blends the nearest layers") {
    require_defined(
        "kbuffer", 4,
        [](defined::Layers layers, const defined::DepthBounds&) {
            return defined::nearest(layers, 4);
        },
        2e-5);
}

// The mean over the pixels: each has trials of its own.
TEST_CASE("stochastic transparency is that of Enderton et al. in the mean") {
    for (const SheetsCase& of : cases()) {
        const oit::Scene scene = scene_of(of.sheets);
        const Difference difference =
            difference_from([](defined::Layers layers,
                               const defined::DepthBounds&) { return defined::stochastic(layers); },
                            sheets_frame(scene, 64), "stochastic");
        INFO(of.name);
        CHECK(difference.mean < (of.sheets.size() == 1 ? 2e-5 : 1e-2));
        CHECK(difference.largest < 0.2);
    }
}

TEST_CASE("layers of one colour have that colour by every approximation, whatever their opacity") {
    for (const SheetsCase& of : cases()) {
        if (of.sheets.size() < 8) continue;
        const oit::Scene scene = scene_of(of.sheets, true);
        for (const oit::MethodInfo& method : oit::methods()) {
            // These leave layers out, so that less light comes from them.
            if (method.exact || method.name == "kbuffer" || method.name == "adaptive") continue;
            const oit::Frame frame = sheets_frame(scene);
            if (!method.refusal(frame, features_of(frame)).empty()) continue;
            const Difference difference = difference_from(
                [](defined::Layers layers, const defined::DepthBounds&) {
                    return defined::nearest(layers, layers.size());
                },
                frame, method.name.data());
            INFO(method.name << ", " << of.name);
            CHECK(difference.largest < 1e-4);
        }
    }
}

}  // namespace
}  // namespace cellist::test
