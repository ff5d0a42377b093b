#include <iostream>
#include <utility>
#include <vector>

#include <cellist/cellist.hpp>

#include "command_line.hpp"
#include "comparison.hpp"
#include "frame.hpp"
#include "image.hpp"
#include "options.hpp"
#include "picture.hpp"
#include "progress.hpp"
#include "reference.hpp"
#include "renderer.hpp"
#include "report.hpp"
#include "stopwatch.hpp"

namespace {

void check_output_paths(const oit::Options& options) {
    support::check_image_path(options.out);
    if (!options.json.empty()) support::check_image_path(options.json);
}

oit::PassTimes median_times(const std::vector<oit::PassTimes>& frames) {
    const auto of = [&](double oit::PassTimes::*pass) {
        std::vector<double> values;
        for (const oit::PassTimes& frame : frames) values.push_back(frame.*pass);
        return support::median(std::move(values));
    };
    return {of(&oit::PassTimes::transform_ms), of(&oit::PassTimes::raster_insert_ms),
            of(&oit::PassTimes::sort_blend_ms)};
}

// Draws as often as asked for, and as often again by passes.
void draw_frames(oit::Renderer& renderer, std::uint32_t count, oit::Report& report) {
    support::Progress progress("drawing");
    progress.update(0);
    renderer.draw();  // builds the kernels' last variants and grows the pool
    renderer.draw();
    std::vector<double> frames;
    std::vector<oit::PassTimes> passes;
    for (std::uint32_t i = 0; i < count; ++i) {
        progress.update(0.5 * i / count);
        frames.push_back(renderer.draw());
    }
    for (std::uint32_t i = 0; i < count; ++i) {
        progress.update(0.5 + 0.5 * i / count);
        passes.push_back(renderer.draw_by_pass());
    }
    report.frame_ms = support::median(std::move(frames));
    report.passes = median_times(passes);
}

oit::Comparison compare_with_reference(const oit::Frame& frame, const oit::Renderer& renderer,
                                       const std::vector<cl_float4>& image) {
    support::Progress progress("reference");
    const oit::Reference reference =
        oit::draw_reference(frame, {.progress = [&](double part) { progress.update(part); }});
    return oit::compare(reference, image, renderer.method().depths());
}

void run(const oit::Options& options) {
    check_output_paths(options);
    const cellist::Device device = oit::choose_device(options);
    oit::Scene scene = oit::make_scene(options);
    const std::uint64_t triangles = scene.triangles();
    if (options.opaque_floor) oit::add_floor(scene);
    const oit::Frame frame = oit::make_frame(scene, options);
    oit::Renderer renderer(device, frame, oit::method_named(options.method));

    oit::Report report;
    report.options = options;
    report.device = device.info().name;
    report.driver = device.info().driver;
    report.triangles = triangles;
    if (!scene.models.empty()) {
        report.drops = scene.models.front().mesh.drops;
        report.mesh_ends_within_line = scene.models.front().mesh.ends_within_line;
    }
    report.node_bytes = 4 * renderer.layout().words;
    report.colour_max = renderer.needs().colour_max;
    draw_frames(renderer, options.frames, report);
    const std::vector<cl_float4> image = renderer.image();
    report.pixels_nan = oit::count_nan(image);
    support::write_png(options.out, oit::side_by_side(image, frame), oit::picture_width(frame),
                       frame.height());

    report.lengths = renderer.method().lengths();
    report.method_bytes = renderer.method().device_bytes();
    report.device_bytes = renderer.device_bytes();
    if (options.reference) report.comparison = compare_with_reference(frame, renderer, image);
    if (!options.json.empty()) oit::write_json(report, options.json);
    oit::print(report, std::cout);
}

}  // namespace

int main(int count, char** arguments) {
    return support::run_program("cellist-oit", [&] {
        const oit::Options options = oit::parse_options(count, arguments);
        if (options.help)
            std::cout << options.help_text;
        else
            run(options);
        return true;
    });
}
