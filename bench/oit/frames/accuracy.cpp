// SPDX-License-Identifier: MIT
// All layers in float nodes against the reference in double precision, for every scene.

#include <cmath>

#include "methods/renderer.hpp"
#include "oit/frames/run.hpp"
#include "oit/other_orders.hpp"
#include "reference/comparison.hpp"
#include "scene/scenes.hpp"

namespace bench {
namespace {

using oit::FrameOptions;

Case samples(const Case& original, int count) {
    return with(original, std::to_string(count) + " samples",
                [=](FrameOptions& options) { options.quality.samples = count; });
}

Case blended(const Case& original, const std::string& what, oit::Blend blend) {
    return with(original, what, [=](FrameOptions& options) { options.blend = blend; });
}

Case two_eyes(const Case& original) {
    return with(original, "two eyes", [](FrameOptions& options) { options.eye_separation = 0.1; });
}

Case resolved_by_sample(const Case& original) {
    return with(original, "each on its own",
                [](FrameOptions& options) { options.quality.resolve = oit::Resolve::per_sample; });
}

Case depth_ranges(const Case& original) {
    return with(original, "ranges of depth",
                [](FrameOptions& options) { options.quality.depth_range = true; });
}

Case on_floor(const Case& original) {
    return with(original, "opaque floor",
                [](FrameOptions& options) { options.opaque_floor = true; });
}

std::vector<Case> all_cases() {
    const Case teapot = mesh_case("teapot.obj"), dragon = mesh_case("dragon.ply");
    std::vector<Case> cases{teapot,
                            two_eyes(teapot),
                            resolved_by_sample(samples(teapot, 8)),
                            dragon,
                            on_floor(dragon),
                            two_eyes(on_floor(dragon)),
                            samples(dragon, 2),
                            samples(dragon, 4),
                            samples(dragon, 8),
                            depth_ranges(samples(dragon, 4)),
                            blended(dragon, "additive", oit::Blend::additive),
                            blended(dragon, "multiplicative", oit::Blend::multiplicative),
                            blended(dragon, "absorb", oit::Blend::absorb)};
    for (const oit::SceneInfo& scene : oit::scenes()) {
        Case its = scene_case(std::string(scene.name));
        // 10,000 layers take gigabytes at the full size.
        if (scene.name.starts_with("extreme-")) its.options.width = its.options.height = 240;
        cases.push_back(its);
    }
    for (const char* scene : {"gearworks", "smoke"}) {
        cases.push_back(samples(scene_case(scene), 4));
        cases.push_back(two_eyes(scene_case(scene)));
    }
    return cases;
}

}  // namespace

void measure_accuracy(Run& run) {
    run.measure("accuracy", all_cases(), [&](const Stage& stage) -> std::vector<Run::Row> {
        oit::Renderer renderer(run.device(), stage.frame);
        renderer.draw();
        const oit::Reference reference = oit::draw_reference(stage.frame);
        const std::vector<cl_float4> image = renderer.image();
        const oit::Comparison c = oit::compare(reference, image, renderer.method().depths());
        const int samples = stage.frame.quality.samples;
        const bool equal = std::isinf(c.psnr_db);
        return {{{"samples", samples},
                 {"eyes", stage.frame.views.size()},
                 {"fragments", c.fragments},
                 {"most_layers", reference.most_layers()},
                 {"pixels", c.pixels},
                 {"pixels_over", c.pixels_over},
                 {"pixels_explained", c.pixels_explained},
                 {"pixels_of_another_order", pixels_of_another_order(reference, image, samples)},
                 {"pixels_ambiguous", c.pixels_ambiguous},
                 {"pixels_with_other_count", c.pixels_with_other_count},
                 {"pixels_nan", c.pixels_nan},
                 {"max_abs_error", c.max_abs_error},
                 {"psnr_db", equal ? Run::Row(nullptr) : Run::Row(c.psnr_db)}}};
    });
}

}  // namespace bench
