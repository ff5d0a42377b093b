// SPDX-License-Identifier: MIT
#include <functional>
#include <iostream>
#include <optional>
#include <utility>
#include <vector>

#include <sys/resource.h>

#include <cellist/cellist.hpp>

#include "budget/budget_controller.hpp"
#include "command_line.hpp"
#include "files.hpp"
#include "frame/frame.hpp"
#include "image.hpp"
#include "image_difference.hpp"
#include "json_report.hpp"
#include "methods/renderer.hpp"
#include "methods/view_mean.hpp"
#include "options.hpp"
#include "progress.hpp"
#include "reference/comparison.hpp"
#include "report/picture.hpp"
#include "report/report.hpp"
#include "stopwatch.hpp"
#ifdef CELLIST_EXAMPLE_MPI
#include <cellist/mpi.hpp>

#include "mpi/distributed_lists.hpp"
#include "mpi_job.hpp"
#endif

namespace {

oit::PassTimes median_times(const std::vector<oit::PassTimes>& frames) {
    const auto of = [&](double oit::PassTimes::*pass) {
        std::vector<double> values;
        for (const oit::PassTimes& frame : frames) values.push_back(frame.*pass);
        return support::median(std::move(values));
    };
    return {of(&oit::PassTimes::transform_ms), of(&oit::PassTimes::raster_insert_ms),
            of(&oit::PassTimes::sort_blend_ms)};
}

// Puts the frame at its moment: the i-th of `count`.
void set_moment(oit::Frame& frame, const oit::Options& options, std::uint32_t i,
                std::uint32_t count) {
    if (!options.moves()) return;
    const double part = count > 1 ? static_cast<double>(i) / (count - 1) : 0;
    oit::FrameOptions moment = options;
    moment.time += part * (options.until.value_or(options.time) - options.time);
    moment.orbit.azimuth_degrees += part * options.turn_degrees;
    frame.time = moment.time;
    frame.views = oit::make_views(moment);
}

// The most that the process has had in main memory.
std::uint64_t peak_bytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return 1024 * static_cast<std::uint64_t>(usage.ru_maxrss);
}

void write_picture(const oit::Options& options, const oit::Frame& frame,
                   const std::vector<cl_float4>& image, std::uint32_t number) {
    support::write_image(options.out.of(number), oit::side_by_side(image, frame),
                         oit::picture_width(frame), frame.height());
}

struct TimedImage {
    double milliseconds;
    const oit::Renderer* renderer;  ///< that has the image
};

// Calls draw() for each moment. Writes the pictures of all frames if their name has a number.
std::vector<double> draw_frames(oit::Frame& frame, const oit::Options& options,
                                const std::function<TimedImage()>& draw) {
    support::Progress progress("drawing");
    progress.update(0);
    std::vector<double> frames;
    for (std::uint32_t i = 0; i < options.frames; ++i) {
        progress.update(static_cast<double>(i) / options.frames);
        set_moment(frame, options, i, options.frames);
        const auto [milliseconds, renderer] = draw();
        frames.push_back(milliseconds);
        if (options.writes() && options.out.has_number())
            write_picture(options, frame, renderer->image(), i + 1);
    }
    return frames;
}

// Draws the last moment again, pass by pass.
oit::PassTimes draw_passes(oit::Renderer& renderer, std::uint32_t count) {
    support::Progress progress("drawing by passes");
    std::vector<oit::PassTimes> passes;
    for (std::uint32_t i = 0; i < count; ++i) {
        progress.update(static_cast<double>(i) / count);
        passes.push_back(renderer.draw_by_pass());
    }
    return median_times(passes);
}

oit::Reference reference_of(const cellist::Device& device, const oit::Frame& frame) {
    support::Progress progress("reference");
    return oit::reference_of(device, frame, [&](double part) { progress.update(part); });
}

void write_reference(const oit::Options& options, const oit::Frame& frame,
                     const std::vector<cl_float4>& image, const oit::Reference& reference) {
    const int width = oit::picture_width(frame), height = frame.height();
    const std::vector<cl_float4> wanted = oit::side_by_side(oit::linear_image(reference), frame);
    if (!options.write_reference.empty())
        support::write_image(options.write_reference, wanted, width, height);
    const std::filesystem::path& path = options.write_difference;
    if (path.empty()) return;
    support::write_difference(path, oit::side_by_side(image, frame), wanted, width, height);
}

// With all layers; and with as many as were asked for, which tells what the device makes of these.
// Pictures through a lens have no reference of the nearest layers.
void compare_with_references(oit::Report& report, const cellist::Device& device,
                             const oit::Frame& frame, const oit::Renderer& renderer,
                             const std::vector<cl_float4>& image) {
    oit::Frame all = frame;
    all.quality.layers.reset();
    const oit::Reference reference = reference_of(device, all);
    report.reference_views = oit::reference_views(frame);
    report.comparison = oit::compare(reference, image, renderer.method().depths());
    write_reference(report.options, frame, image, reference);
    if (frame.quality.layers && !frame.lens)
        report.nearest_comparison =
            oit::compare(reference_of(device, frame), image, renderer.method().depths());
}

void draw_with_method(oit::Report& report, oit::Renderer& renderer, oit::Frame& frame) {
    renderer.warm_up();
    const bool changes = report.options.moves();
    report.times.add(draw_frames(frame, report.options, [&] {
        return TimedImage{changes ? renderer.draw_changed() : renderer.draw(), &renderer};
    }));
    report.passes = draw_passes(renderer, report.options.frames);
}

void draw_within_budget(oit::Report& report, oit::BudgetController& controller, oit::Frame& frame) {
    oit::BudgetRecord& record = report.record;
    report.times.add(draw_frames(frame, report.options, [&] {
        const oit::BudgetController::Drawn drawn = controller.draw();
        record.add(drawn, frame.time, *report.options.budget);
        return TimedImage{drawn.frame_ms, &controller.renderer()};
    }));
    report.passes = draw_passes(controller.renderer(), report.options.frames);
    report.choice = controller.choice();
    report.options.method = report.choice->setting.method->name;
    report.options.quality = report.choice->setting.quality;
}

void describe(oit::Report& report, const oit::Scene& scene, const cellist::Device& device) {
    report.device = device.info().name;
    report.driver = device.info().driver;
    report.meshes = scene.meshes;
    for (const oit::SceneMesh& mesh : scene.meshes) report.drops += mesh.drops;
}

void write(oit::Report& report, const cellist::Device& device, const oit::Frame& frame,
           oit::Renderer& renderer) {
    const oit::Options& options = report.options;
    if (oit::method_named(options.method).has_nodes)
        report.node_bytes = 4 * renderer.layout().words;
    report.colour_max = renderer.features().colour_max;
    report.lengths = renderer.method().lengths();
    if (!options.writes()) return;
    const std::vector<cl_float4> image = renderer.image();
    report.pixels_nan = oit::count_nan(image);
    if (!options.out.has_number()) write_picture(options, frame, image, 1);
    report.blends_slices = renderer.method().blends_slices();
    report.slices = renderer.method().slices();
    report.method_bytes = renderer.method().device_bytes();
    report.device_bytes = renderer.device_bytes();
    if (options.reference) compare_with_references(report, device, frame, renderer, image);
    if (!options.heatmap.empty())
        oit::write_layers(options.heatmap, renderer.layers(), renderer.drawn_frame());
    report.peak_bytes = peak_bytes();
    if (!options.json.empty())
        support::write_file(options.json, support::dump(to_json(report), 2) + '\n');
    oit::print(report, options.writes_to_stdout() ? std::cerr : std::cout);
}

cellist::Device choose_device(const oit::Options& options) {
#ifdef CELLIST_EXAMPLE_MPI
    if (options.mpi && options.device.empty()) {
        cellist::Device device = cellist::mpi::choose(MPI_COMM_WORLD);
        oit::check_size(options, device);
        return device;
    }
#endif
    return oit::choose_device(options);
}

oit::MethodInfo method_of(const oit::Options& options) {
#ifdef CELLIST_EXAMPLE_MPI
    if (options.mpi) return oit::distributed(oit::method_named(options.method));
#endif
    return oit::method_named(options.method);
}

// The exit code: 2 where no setting meets the budget.
int run(const oit::Options& options) {
    const cellist::Device device = choose_device(options);
    oit::Scene scene = oit::make_scene(options);
    if (options.until) oit::require_motion(scene, options, "--until");
    oit::Report report;
    report.options = options;
    report.triangles = scene.triangles();
    oit::stand_on_floor(scene, options);
    describe(report, scene, device);
#ifdef CELLIST_EXAMPLE_MPI
    if (options.mpi) report.device = support::devices_of_all_ranks(report.device);
#endif
    oit::Frame frame = oit::make_frame(scene, options);
    frame.memory_bytes = options.memory_bytes;
    frame.share = options.share;
    if (!options.budget) {
        oit::Renderer renderer(device, frame, method_of(options));
        draw_with_method(report, renderer, frame);
        write(report, device, frame, renderer);
        return 0;
    }
    set_moment(frame, options, 0, options.frames);
    std::optional<support::Progress> choosing;
    const auto show_choosing = [&](double part) {
        if (!choosing) choosing.emplace("choosing a setting");
        choosing->update(part);
        if (part == 1) choosing.reset();
    };
    oit::BudgetController controller(
        device, frame, *options.budget, options.check_every,
        {.progress = show_choosing, .seconds = options.search_seconds});
    draw_within_budget(report, controller, frame);
    // `frame` keeps its own quality, so the reference has all layers.
    write(report, device, frame, controller.renderer());
    return report.record.met() ? 0 : 2;
}

bool run_on_ranks(oit::Options options) {
#ifdef CELLIST_EXAMPLE_MPI
    support::MpiJob job("cellist-oit");
    options.share = {static_cast<std::size_t>(job.rank()), static_cast<std::size_t>(job.ranks())};
    return job.run([&] { return run(options) == 0; });
#else
    (void)options;
    support::refuse_mpi();
#endif
}

}  // namespace

int main(int count, char** arguments) {
    int exit_code = 0;
    const int failed = support::run_program("cellist-oit", [&] {
        const oit::Options options = oit::parse_options(count, arguments);
        if (!options.help_text.empty())
            std::cout << options.help_text;
        else if (options.mpi)
            return run_on_ranks(options);
        else
            exit_code = run(options);
        return true;
    });
    return failed != 0 ? failed : exit_code;
}
