// SPDX-License-Identifier: MIT
// The nearest layers against all layers: the gain in time and the loss in the picture.

#include <array>
#include <cmath>
#include <memory>

#include "budget/setting.hpp"
#include "methods/renderer.hpp"
#include "oit/frames/run.hpp"
#include "reference/comparison.hpp"

namespace bench {
namespace {

constexpr std::array layer_counts{1U, 2U, 4U, 8U, 16U, 32U};

// A picture of the device that takes the place of the reference.
oit::Reference reference_of(const oit::Renderer& renderer, const oit::Frame& frame) {
    oit::Reference reference;
    reference.width = static_cast<std::size_t>(frame.width());
    reference.height = static_cast<std::size_t>(frame.height());
    for (const cl_float4& pixel : renderer.image())
        reference.image.emplace_back(pixel.s[0], pixel.s[1], pixel.s[2]);
    reference.ambiguous.assign(reference.image.size(), false);
    return reference;
}

// A frame with a setting: its renderer refers to it.
struct Drawing {
    Drawing(const cellist::Device& device, const oit::Frame& all, const oit::Quality& quality)
        : frame(oit::with_setting(all, {&oit::method_named("linked"), quality})),
          renderer(device, frame) {}

    oit::Frame frame;
    oit::Renderer renderer;
};

}  // namespace

void measure_fewer_layers(Run& run) {
    const std::array cases{gearworks_of_most_layers()};
    run.measure("fewer_layers", cases, [&](const Stage& stage) {
        std::vector<std::unique_ptr<Drawing>> drawn;
        std::vector<std::function<double()>> drawings;
        const auto add = [&](const std::optional<std::uint32_t>& layers) {
            oit::Quality quality = stage.frame.quality;
            quality.layers = layers;
            drawn.push_back(std::make_unique<Drawing>(run.device(), stage.frame, quality));
            drawn.back()->renderer.warm_up();
            drawings.emplace_back([&last = *drawn.back()] { return last.renderer.draw(); });
        };
        add({});
        for (const std::uint32_t layers : layer_counts) add(layers);
        const std::vector<Samples> times = run.draw_interleaved(drawings);

        const oit::Renderer& all = drawn.front()->renderer;
        const oit::Reference reference = reference_of(all, stage.frame);
        std::vector<Run::Row> rows;
        for (std::size_t i = 0; i < drawn.size(); ++i) {
            const auto& layers = drawn[i]->frame.quality.layers;
            const oit::Comparison comparison =
                oit::compare(reference, drawn[i]->renderer.image(), {});
            Run::Row row{
                {"layers", layers ? Run::Row(*layers) : Run::Row("all")},
                {"most_layers", all.method().lengths()->longest},
                {"speed_up", times.front().median / times[i].median},
                {"psnr_db", std::isfinite(comparison.psnr_db) ? Run::Row(comparison.psnr_db)
                                                              : Run::Row(nullptr)}};
            row.update(to_json(times[i]));
            rows.push_back(std::move(row));
        }
        return rows;
    });
}

}  // namespace bench
