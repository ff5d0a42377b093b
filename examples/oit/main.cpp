#include <iostream>
#include <utility>
#include <vector>

#include <cellist/cellist.hpp>

#include "command_line.hpp"
#include "comparison.hpp"
#include "frame.hpp"
#include "image.hpp"
#include "options.hpp"
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

// Rows of all eyes side by side.
std::vector<cl_float4> side_by_side(const std::vector<cl_float4>& image, const oit::Frame& frame) {
    const auto width = static_cast<std::size_t>(frame.width());
    const auto height = static_cast<std::size_t>(frame.height());
    std::vector<cl_float4> rows;
    for (std::size_t y = 0; y < height; ++y)
        for (std::size_t eye = 0; eye < frame.views.size(); ++eye) {
            const auto row =
                image.begin() + static_cast<std::ptrdiff_t>((eye * height + y) * width);
            rows.insert(rows.end(), row, row + static_cast<std::ptrdiff_t>(width));
        }
    return rows;
}

oit::PassTimes median_times(const std::vector<oit::PassTimes>& frames) {
    const auto of = [&](double oit::PassTimes::*pass) {
        std::vector<double> values;
        for (const oit::PassTimes& frame : frames) values.push_back(frame.*pass);
        return support::median(std::move(values));
    };
    return {of(&oit::PassTimes::transform_ms), of(&oit::PassTimes::raster_insert_ms),
            of(&oit::PassTimes::sort_blend_ms), of(&oit::PassTimes::frame_ms)};
}

oit::PassTimes draw_frames(oit::Renderer& renderer, std::uint32_t count) {
    support::Progress progress("drawing");
    progress.update(0);
    renderer.draw();  // builds the kernels' last variants and grows the pool
    std::vector<oit::PassTimes> frames;
    for (std::uint32_t i = 0; i < count; ++i) {
        progress.update(static_cast<double>(i) / count);
        frames.push_back(renderer.draw());
    }
    return median_times(frames);
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
    report.times = draw_frames(renderer, options.frames);
    const std::vector<cl_float4> image = renderer.image();
    report.pixels_nan = oit::count_nan(image);
    support::write_png(options.out, side_by_side(image, frame),
                       options.width * static_cast<int>(frame.views.size()), options.height);

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
