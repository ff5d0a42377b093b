// SPDX-License-Identifier: MIT
// One-bounce indirect light, with shadows by rays through a grid of triangle lists.
#include <algorithm>
#include <iostream>
#include <vector>

#include <cellist/cellist.hpp>

#include "command_line.hpp"
#include "files.hpp"
#include "frame.hpp"
#include "heat_map.hpp"
#include "image.hpp"
#include "input_error.hpp"
#include "json_report.hpp"
#include "number_text.hpp"
#include "options.hpp"
#include "report.hpp"
#include "stopwatch.hpp"
#include "trade.hpp"

namespace {

using shadows::FrameReport;
using shadows::Options;
using shadows::Renderer;

// Draws the frames and, where the picture's name has a number, writes each.
std::vector<double> draw_frames(const cellist::Device& device, const Options& options,
                                shadows::Scene& scene, Renderer& renderer) {
    renderer.draw(scene);
    std::vector<double> frames_ms;
    for (std::uint32_t frame = 1; frame <= options.frames; ++frame) {
        if (scene.move) scene.move(scene, options.time + options.time_step * (frame - 1));
        frames_ms.push_back(support::measure_ms(device, [&] { renderer.draw(scene); }));
        if (options.out.has_number())
            support::write_image(options.out.of(frame), renderer.picture().download(),
                                 options.settings.width, options.settings.height);
    }
    return frames_ms;
}

void write_pictures(const Options& options, const shadows::Scene& scene, Renderer& renderer,
                    FrameReport& report) {
    const int width = options.settings.width, height = options.settings.height;
    const auto write = [&](const std::filesystem::path& path, const auto& buffer, int columns,
                           int rows) {
        if (!path.empty()) support::write_image(path, buffer.download(), columns, rows);
    };
    if (!options.out.has_number()) write(options.out.path(), renderer.picture(), width, height);
    write(options.out_unblocked, renderer.unblocked(), width, height);
    write(options.out_a, renderer.a(), width, height);
    write(options.out_b, renderer.b(), renderer.b_width(), renderer.b_height());
    if (!options.heatmap.empty()) {
        const std::vector<cl_uint> passed = renderer.passed_entries(scene);
        report.most_passed = *std::ranges::max_element(passed);
        support::write_heat_map(options.heatmap,
                                {.values = std::vector<double>(passed.begin(), passed.end()),
                                 .width = width,
                                 .height = height,
                                 .caption = "list entries"});
    }
    if (!options.out_error.empty()) {
        const support::ImageDifference& error = report.accuracy->picture;
        if (!report.accuracy->all_pixels)
            throw support::InputError("--out-error needs Embree for this scene (libembree-dev)");
        support::write_heat_map(options.out_error, {.values = error.errors,
                                                    .width = width,
                                                    .height = height,
                                                    .caption = "error",
                                                    .are_counts = false});
    }
}

bool run(const Options& options) {
    const bool uses_stdout = options.writes_to_stdout();
    std::ostream& screen = uses_stdout ? std::cerr : std::cout;
    const cellist::Device device = options.device.empty() ? cellist::Device::choose()
                                                          : cellist::Device::choose(options.device);
    shadows::Scene scene = make_scene(options);
    if (options.trade) return shadows::run_trade(device, options, scene, screen);

    Renderer renderer(device, scene, options.settings);
    FrameReport report;
    report.options = options;
    report.device = device.info().name;
    report.driver = device.info().driver;
    report.frames_ms = draw_frames(device, options, scene, renderer);
    report.passes_ms =
        support::median_passes(device, std::min(options.frames, 5U),
                               [&](support::PassTimes& times) { renderer.draw(scene, &times); });
    if (options.reference) report.accuracy = compare_with_reference(renderer, scene);
    report.counts = renderer.counts();
    report.lengths = renderer.grid().entries().lengths();
    report.cells = renderer.grid().cells();
    report.scene_triangles = shadows::triangle_count(scene);
    report.blockers = renderer.grid().triangles().size();
    report.device_bytes = renderer.device_bytes();
    write_pictures(options, scene, renderer, report);
    if (!options.json.empty())
        support::write_file(options.json, support::dump(to_json(report), 2) + '\n');

    print(screen, report);
    screen << "written     " << support::text_of(options.out.path()) << '\n';
    if (options.arguments.empty())
        screen << "next        --out-a and --out-b write the indirect light and what is blocked of "
                  "it;\n            --reference checks every ray; 'swarm' moves; a mesh file takes "
                  "its place\n";
    return !report.accuracy || report.accuracy->rays_different == 0;
}

}  // namespace

int main(int count, char** arguments) {
    return support::run_program("cellist-shadows", [&] {
        const Options options = shadows::parse_options(count, arguments);
        if (options.help_text.empty()) return run(options);
        std::cout << options.help_text;
        return true;
    });
}
