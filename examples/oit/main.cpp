#include <algorithm>
#include <iostream>
#include <string>
#include <vector>

#include <cellist/cellist.hpp>

#include "command_line.hpp"
#include "comparison.hpp"
#include "frame.hpp"
#include "image.hpp"
#include "input_error.hpp"
#include "mesh.hpp"
#include "options.hpp"
#include "progress.hpp"
#include "reference.hpp"
#include "renderer.hpp"
#include "report.hpp"
#include "scenes.hpp"

namespace {

using support::InputError;

void check_output_paths(const oit::Options& options) {
    support::check_image_path(options.out);
    if (!options.json.empty()) support::check_image_path(options.json);
}

// The largest buffers of a frame: image and opaque colour with 16 bytes a sample.
void check_size(const oit::Options& options, const cellist::Device& device) {
    const std::string size =
        "--size " + std::to_string(options.width) + "x" + std::to_string(options.height);
    const std::uint64_t bytes = 16 * static_cast<std::uint64_t>(options.width) *
                                static_cast<std::uint64_t>(options.height) *
                                static_cast<std::uint64_t>(options.quality.samples) *
                                (options.eye_separation ? 2 : 1);
    const std::uint64_t limit = device.info().max_allocation_bytes;
    if (bytes > limit)
        throw InputError(size + " needs an image of " + std::to_string(bytes) +
                         " bytes, this device allocates at most " + std::to_string(limit) +
                         " at once");
    if (options.width > RASTER_SIDE_MAX || options.height > RASTER_SIDE_MAX)
        throw InputError(size + ": each side has at most " + std::to_string(RASTER_SIDE_MAX) +
                         " pixels");
}

void set_blend(oit::Scene& scene, oit::Blend blend) {
    for (oit::Material& material : scene.materials)
        if (material.blend != static_cast<cl_uint>(oit::Blend::opaque))
            material.blend = static_cast<cl_uint>(blend);
}

oit::Scene make_scene(const oit::Options& options) {
    oit::Scene scene;
    if (const oit::SceneInfo* info = oit::find_scene(options.scene)) {
        scene = info->make(options.alpha);
    } else {
        support::Mesh mesh = support::load_mesh(options.scene);
        support::fit_to_unit_sphere(mesh);
        scene = oit::scene_of(std::move(mesh), options.alpha);
    }
    if (options.blend) set_blend(scene, *options.blend);
    return scene;
}

std::vector<raster::View> make_views(const oit::Options& options) {
    if (options.eye_separation)
        return support::frame_unit_sphere(options.orbit, options.width, options.height,
                                          *options.eye_separation);
    return {support::frame_unit_sphere(options.orbit, options.width, options.height)};
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

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    const std::size_t half = values.size() / 2;
    return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

oit::PassTimes median_times(const std::vector<oit::PassTimes>& frames) {
    const auto of = [&](double oit::PassTimes::*pass) {
        std::vector<double> values;
        for (const oit::PassTimes& frame : frames) values.push_back(frame.*pass);
        return median(values);
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
    report.frame_ms = median(frames);
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
    const cellist::Device device = options.device.empty() ? cellist::Device::choose()
                                                          : cellist::Device::choose(options.device);
    check_size(options, device);

    oit::Scene scene = make_scene(options);
    const std::uint64_t triangles = scene.triangles();
    if (options.opaque_floor) oit::add_floor(scene);
    const oit::Frame frame{.scene = scene,
                           .views = make_views(options),
                           .time = options.time,
                           .quality = options.quality,
                           .blend_function = options.blend_function,
                           .memory_bytes = options.memory_bytes};
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
    support::write_png(options.out, side_by_side(image, frame),
                       options.width * static_cast<int>(frame.views.size()), options.height);

    report.lengths = renderer.method().lengths();
    report.slices = renderer.method().slices();
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
