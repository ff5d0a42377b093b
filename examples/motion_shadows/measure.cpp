// SPDX-License-Identifier: MIT
#include "measure.hpp"

#include <algorithm>

#include "accumulate.hpp"
#include "input_error.hpp"
#include "progress.hpp"
#include "stopwatch.hpp"

namespace motion {
namespace {

constexpr std::array<cl_uint, 5> trade_samples{8, 16, 20, 32, 64};
// Lists find their size in the first frame, and make room for it in the second.
constexpr int warm_up_frames = 2;
constexpr std::uint32_t pass_frames_max = 5;

Measurement draw_reference(const cellist::Device& device, const Scene& scene,
                           const Options& options) {
    Settings settings = options.settings;
    settings.samples = 1;
    Frame frame(device, scene, settings);
    Accumulation accumulation(frame);
    Measurement result{.method = reference_name, .samples = options.moments};
    support::Progress progress("reference");
    result.frames_ms.push_back(support::measure_ms(device, [&] {
        // The queue stays short, so that the progress is true.
        constexpr cl_uint step = 8;
        for (cl_uint first = 0; first < options.moments; first += step) {
            accumulation.draw(first, std::min(step, options.moments - first), options.moments);
            device.finish();
            progress.update(static_cast<double>(first) / options.moments);
        }
        result.picture = accumulation.picture(options.moments);
    }));
    return result;
}

// Names the option where the lists of a shadow map do not fit into --memory at all.
std::unique_ptr<ShadowMethod> make_method(const NamedMethod& named, Renderer& renderer) {
    const Settings& settings = renderer.frame().settings;
    try {
        std::unique_ptr<ShadowMethod> method = named.make(renderer.frame());
        renderer.draw(*method);
        return method;
    } catch (const cellist::MemoryError&) {
        if (settings.budget_bytes == no_budget) throw;
        throw support::InputError("--memory " + std::to_string(settings.budget_bytes) +
                                  " is too little for a shadow map of " +
                                  std::to_string(settings.shadow_map) + " x " +
                                  std::to_string(settings.shadow_map) + " texels: raise it");
    }
}

Measurement draw_with(const NamedMethod& named, Renderer& renderer, const Options& options) {
    const cellist::Device& device = renderer.frame().device;
    const std::unique_ptr<ShadowMethod> method = make_method(named, renderer);
    Measurement result{.method = named.name, .samples = renderer.frame().settings.samples};
    for (int frame = 1; frame < warm_up_frames; ++frame) renderer.draw(*method);
    for (std::uint32_t frame = 0; frame < options.frames; ++frame)
        result.frames_ms.push_back(support::measure_ms(device, [&] { renderer.draw(*method); }));
    result.passes_ms =
        support::median_passes(device, std::min(options.frames, pass_frames_max),
                               [&](support::PassTimes& times) { renderer.draw(*method, &times); });
    result.size = method->size();
    result.storage = renderer.frame().storage();
    result.picture = renderer.picture().download();
    return result;
}

void compare(Measurement& measurement, const Measurement& reference, const Settings& settings) {
    std::vector<glm::dvec3> colours;
    for (const cl_float4& pixel : reference.picture)
        colours.emplace_back(pixel.s[0], pixel.s[1], pixel.s[2]);
    measurement.comparison = {
        support::difference(measurement.picture, colours, static_cast<std::size_t>(settings.width),
                            static_cast<std::size_t>(settings.height)),
        self_shadowing(measurement.picture, measurement.samples, reference.picture,
                       reference.samples)};
}

}  // namespace

std::vector<Measurement> measure(const cellist::Device& device, const Scene& scene,
                                 const Options& options) {
    std::vector<Measurement> all;
    if (options.reference || options.method == reference_name)
        all.push_back(draw_reference(device, scene, options));
    std::vector<cl_uint> samples{options.settings.samples};
    if (options.trade) samples.assign(trade_samples.begin(), trade_samples.end());
    std::vector<NamedMethod> shown;
    for (const NamedMethod& method : methods)
        if (method.make != nullptr && options.shows(method.name)) shown.push_back(method);
    support::Progress progress("methods");
    for (std::size_t i = 0; i < samples.size(); ++i) {
        Settings settings = options.settings;
        settings.samples = samples[i];
        Renderer renderer(device, scene, settings);
        for (std::size_t k = 0; k < shown.size(); ++k) {
            progress.update(static_cast<double>(i * shown.size() + k) /
                            static_cast<double>(samples.size() * shown.size()));
            all.push_back(draw_with(shown[k], renderer, options));
            if (options.reference) compare(all.back(), all.front(), settings);
        }
    }
    return all;
}

PaperSize paper_size(const cellist::Device& device, const Scene& scene, const Options& options) {
    Settings settings = options.settings;
    settings.width = settings.height = 1;
    settings.samples = 1;
    settings.prepass = false;
    settings.insides = true;
    settings.compress = false;
    Renderer renderer(device, scene, settings);
    const auto size = [&](const std::unique_ptr<ShadowMethod>& method) {
        renderer.draw(*method);
        return method->size();
    };
    const std::uint64_t ranges = size(make_exact(renderer.frame())).ranges;
    const bool has_prisms = options.shows("ranges");
    return {.ranges = ranges,
            .fragments = has_prisms ? size(make_ranges(renderer.frame())).fragments : 2 * ranges};
}

}  // namespace motion
