// SPDX-License-Identifier: MIT
#include <algorithm>
#include <iostream>
#include <optional>

#include <cellist/cellist.hpp>

#include "command_line.hpp"
#include "files.hpp"
#include "input_error.hpp"
#include "json_report.hpp"
#include "methods/renderer.hpp"
#include "methods/view_mean.hpp"
#include "number_text.hpp"
#include "progress.hpp"
#include "report/picture.hpp"
#include "tradeoff/metrics.hpp"
#include "tradeoff/page.hpp"
#include "tradeoff/sweep.hpp"
#include "tradeoff/tradeoff_options.hpp"

namespace {

oit::Reference reference_of(const cellist::Device& device, const oit::Frame& frame) {
    support::Progress progress("reference");
    return oit::reference_of(device, frame, [&](double part) { progress.update(part); });
}

void print_progress(const oit::Measurement& measurement, std::size_t done, std::size_t count) {
    std::cerr << '[' << done << '/' << count << "] " << text(measurement.setting) << ": ";
    if (measurement.drawn())
        std::cerr << support::fixed(measurement.milliseconds, 2) << " ms, "
                  << support::fixed(measurement.comparison.psnr_db, 1) << " dB\n";
    else
        std::cerr << measurement.failure << '\n';
}

struct Layers {
    std::vector<cl_uint> of_pixels;
    oit::Frame frame;  ///< that has these pixels
};

// As the reference has them. If it is a mean of pictures, as the device draws them, with the margin
// of a lens.
Layers layers_of(const cellist::Device& device, const oit::Frame& frame,
                 const oit::Reference& reference) {
    if (oit::reference_views(frame) == 0) return {reference.layers(), frame};
    oit::Renderer renderer(device, frame);
    renderer.draw();
    return {renderer.layers(), renderer.drawn_frame()};
}

void run(const oit::TradeoffOptions& options) {
    const cellist::Device device = oit::choose_device(options);
    oit::Scene scene = oit::make_scene(options);
    oit::Sweep sweep{.options = options,
                     .device = device.info().name,
                     .driver = device.info().driver,
                     .triangles = scene.triangles(),
                     .frames = options.frames};
    oit::stand_on_floor(scene, options);
    const oit::Frame frame = oit::make_frame(scene, options);
    sweep.left_out = oit::left_out(frame, options.methods);
    if (sweep.left_out.size() == options.methods.size())
        throw support::InputError("the method " + std::string(sweep.left_out.front().method) +
                                  " cannot draw this: " + sweep.left_out.front().reason);
    const oit::Reference reference = reference_of(device, frame);
    sweep.reference_views = oit::reference_views(frame);
    const Layers counted = layers_of(device, frame, reference);
    const cellist::Lengths layers(counted.of_pixels);
    if (layers.total == 0)
        throw support::InputError("nothing transparent is in view of '" + oit::title_of(options) +
                                  "', so there is nothing to compare");
    sweep.fragments = layers.total;
    sweep.most_layers = layers.longest;
    sweep.pixels_by_layers = oit::pixels_by_layers(layers);

    std::optional<oit::Pictures> pictures;
    if (!options.html.empty()) pictures.emplace(reference, frame);
    const std::vector<oit::Setting> settings =
        options.all_samples ? oit::settings_of_samples(frame)
                            : oit::settings_of(frame, sweep.most_layers, options.methods);
    std::size_t done = 0;
    support::Progress more_rounds("more rounds");
    sweep.measurements = oit::measure_interleaved(
        device, frame, reference, settings, options.frames,
        [&](oit::Measurement& measurement) {
            if (pictures && measurement.drawn())
                pictures->add(measurement.setting, measurement.image);
            measurement.image = {};  // all of them may be more than memory holds
            print_progress(measurement, ++done, settings.size());
        },
        [&](double part) { more_rounds.update(part); });
    std::ranges::stable_sort(sweep.measurements, {}, [](const oit::Measurement& measurement) {
        return std::pair(!measurement.drawn(), measurement.milliseconds);
    });

    oit::print(sweep, options.writes_to_stdout() ? std::cerr : std::cout);
    if (!options.heatmap.empty())
        oit::write_layers(options.heatmap, counted.of_pixels, counted.frame);
    if (!options.json.empty())
        support::write_file(options.json, support::dump(to_json(sweep), 2) + '\n');
    if (!options.csv.empty()) support::write_file(options.csv, to_csv(sweep));
    if (pictures) support::write_file(options.html, to_html(sweep, *pictures));
}

}  // namespace

int main(int count, char** arguments) {
    return support::run_program("cellist-tradeoff", [&] {
        const oit::TradeoffOptions options = oit::parse_tradeoff_options(count, arguments);
        if (!options.help_text.empty())
            std::cout << options.help_text;
        else
            run(options);
        return true;
    });
}
