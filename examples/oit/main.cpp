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

namespace {

using support::InputError;

void check_output_paths(const oit::Options& options) {
    support::check_image_path(options.out);
    if (!options.json.empty()) support::check_image_path(options.json);
}

// The largest buffers of a frame: image and opaque colour with 16 bytes a pixel.
void check_size(const oit::Options& options, const cellist::Device& device) {
    const std::string size =
        "--size " + std::to_string(options.width) + "x" + std::to_string(options.height);
    const std::uint64_t bytes =
        16 * static_cast<std::uint64_t>(options.width) * static_cast<std::uint64_t>(options.height);
    const std::uint64_t limit = device.info().max_allocation_bytes;
    if (bytes > limit)
        throw InputError(size + " needs an image of " + std::to_string(bytes) +
                         " bytes, this device allocates at most " + std::to_string(limit) +
                         " at once");
    if (options.width > RASTER_SIDE_MAX || options.height > RASTER_SIDE_MAX)
        throw InputError(size + ": each side has at most " + std::to_string(RASTER_SIDE_MAX) +
                         " pixels");
}

oit::Frame make_frame(const oit::Options& options, const support::Mesh& mesh) {
    oit::Frame frame{
        .mesh = mesh,
        .view = support::frame_unit_sphere(options.orbit, options.width, options.height),
        .look = oit::studio_look(options.alpha, oit::floor_height_under(mesh)),
        .layers = options.layers};
    if (options.opaque_floor) frame.floor = oit::make_floor(frame.look);
    return frame;
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
        oit::draw_reference(frame, [&](double part) { progress.update(part); });
    return oit::compare(reference, image, renderer.fragments().download());
}

void run(const oit::Options& options) {
    check_output_paths(options);
    const cellist::Device device = options.device.empty() ? cellist::Device::choose()
                                                          : cellist::Device::choose(options.device);
    check_size(options, device);

    support::Mesh mesh = support::load_mesh(options.mesh);
    support::fit_to_unit_sphere(mesh);
    const oit::Frame frame = make_frame(options, mesh);
    oit::Renderer renderer(device, frame);

    oit::Report report;
    report.options = options;
    report.device = device.info().name;
    report.driver = device.info().driver;
    report.triangles = mesh.triangles.size();
    report.drops = mesh.drops;
    report.mesh_ends_within_line = mesh.ends_within_line;
    report.times = draw_frames(renderer, options.frames);
    const std::vector<cl_float4> image = renderer.image();
    support::write_png(options.out, image, options.width, options.height);

    const cellist::Lengths lengths = renderer.fragments().lengths();
    report.fragments = lengths.total;
    report.cells_nonempty = lengths.nonempty_cells;
    report.longest_list = lengths.longest;
    report.pool_bytes = renderer.fragments().pool_bytes();
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
