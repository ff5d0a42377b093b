#include <functional>
#include <iostream>
#include <utility>
#include <vector>

#include <cellist/cellist.hpp>

#include "command_line.hpp"
#include "comparison.hpp"
#include "frame.hpp"
#include "image.hpp"
#include "keeper.hpp"
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

// Puts the frame at its moment: the i-th of `count`.
void set_moment(oit::Frame& frame, const oit::Options& options, std::uint32_t i,
                std::uint32_t count) {
    if (!options.until && options.turn_degrees == 0) return;
    const double part = count > 1 ? static_cast<double>(i) / (count - 1) : 0;
    oit::FrameOptions moment = options;
    moment.time += part * (options.until.value_or(options.time) - options.time);
    moment.orbit.azimuth_degrees += part * options.turn_degrees;
    frame.time = moment.time;
    frame.views = oit::make_views(moment);
}

// Calls draw() for each moment.
oit::PassTimes draw_frames(oit::Frame& frame, const oit::Options& options,
                           const std::function<oit::PassTimes()>& draw) {
    support::Progress progress("drawing");
    progress.update(0);
    std::vector<oit::PassTimes> frames;
    for (std::uint32_t i = 0; i < options.frames; ++i) {
        progress.update(static_cast<double>(i) / options.frames);
        set_moment(frame, options, i, options.frames);
        frames.push_back(draw());
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

void draw_with_method(oit::Report& report, oit::Renderer& renderer, oit::Frame& frame) {
    renderer.draw();  // builds the kernels' last variants and grows the pool
    const bool changes = report.options.until || report.options.turn_degrees != 0;
    report.times = draw_frames(frame, report.options, [&] {
        return changes ? renderer.draw_changed() : renderer.draw();
    });
}

void draw_within_budget(oit::Report& report, oit::Keeper& keeper, oit::Frame& frame) {
    oit::KeptBudget& kept = report.kept;
    report.times = draw_frames(frame, report.options, [&] {
        const oit::Keeper::Drawn drawn = keeper.draw();
        kept.add(drawn, frame.time, *report.options.budget);
        return drawn.times;
    });
    report.choice = keeper.choice();
    report.options.method = oit::method_text(report.choice->setting);
    report.options.quality = report.choice->setting.quality;
}

void describe(oit::Report& report, const oit::Scene& scene, const cellist::Device& device) {
    report.device = device.info().name;
    report.driver = device.info().driver;
    if (scene.models.empty()) return;
    report.drops = scene.models.front().mesh.drops;
    report.mesh_ends_within_line = scene.models.front().mesh.ends_within_line;
}

void write(oit::Report& report, const oit::Frame& frame, const oit::Renderer& renderer) {
    const oit::Options& options = report.options;
    report.node_bytes = 4 * renderer.layout().words;
    report.colour_max = renderer.needs().colour_max;
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

// The exit code: 2 where no setting meets the budget.
int run(const oit::Options& options) {
    check_output_paths(options);
    const cellist::Device device = oit::choose_device(options);
    oit::Scene scene = oit::make_scene(options);
    oit::Report report;
    report.options = options;
    report.triangles = scene.triangles();
    if (options.opaque_floor) oit::add_floor(scene);
    describe(report, scene, device);
    oit::Frame frame = oit::make_frame(scene, options);
    if (!options.budget) {
        oit::Renderer renderer(device, frame, oit::method_named(options.method));
        draw_with_method(report, renderer, frame);
        write(report, frame, renderer);
        return 0;
    }
    set_moment(frame, options, 0, options.frames);
    oit::Keeper keeper(device, frame, *options.budget, options.check_every);
    draw_within_budget(report, keeper, frame);
    // The reference is that of all layers.
    write(report, frame, keeper.renderer());
    return report.kept.met() ? 0 : 2;
}

}  // namespace

int main(int count, char** arguments) {
    int exit_code = 0;
    const int failed = support::run_program("cellist-oit", [&] {
        const oit::Options options = oit::parse_options(count, arguments);
        if (options.help)
            std::cout << options.help_text;
        else
            exit_code = run(options);
        return true;
    });
    return failed != 0 ? failed : exit_code;
}
