// Order-independent transparency with one list per pixel: the whole of it.
#include <iostream>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>

#include "camera.hpp"
#include "command_line.hpp"
#include "files.hpp"
#include "image.hpp"
#include "input_error.hpp"
#include "transparency.hpp"

namespace {

struct Options {
    std::string mesh;
    std::string out = "transparency.png";
    std::string device;
    double alpha = 0.3;
    int width = 800, height = 600;
    support::Orbit camera{.azimuth_degrees = 25, .elevation_degrees = 15};
};

/// Returns the text to print if the command line asks for help.
std::optional<std::string> parse_options(Options& options, int count,
                                         const char* const* arguments) {
    CLI::App app{"Draws a mesh whose every surface is transparent.", "transparency"};
    app.add_option("mesh", options.mesh, "mesh to read: PLY, OBJ, glTF, STL, OFF, ...")
        ->type_name("MESH")
        ->required();
    app.add_option("--out", options.out, "picture to write: .png, .jpg, .pfm or .exr")
        ->type_name("FILE")
        ->capture_default_str();
    app.add_option("--alpha", options.alpha, "opacity of a surface that faces the eye")
        ->check(CLI::Range(0.0, 1.0))
        ->capture_default_str();
    app.add_option("--width", options.width, "of the picture in pixels")
        ->check(CLI::Range(1, RASTER_SIDE_MAX))
        ->capture_default_str();
    app.add_option("--height", options.height, "of the picture in pixels")
        ->check(CLI::Range(1, RASTER_SIDE_MAX))
        ->capture_default_str();
    app.add_option("--azimuth", options.camera.azimuth_degrees, "of the camera, in degrees")
        ->capture_default_str();
    app.add_option("--elevation", options.camera.elevation_degrees, "of the camera, in degrees")
        ->check(CLI::Range(-90.0, 90.0))
        ->capture_default_str();
    app.add_option("--device", options.device,
                   "index or part of the name of the device; else CELLIST_DEVICE, a GPU, or the "
                   "first")
        ->type_name("D");
    return support::parse_command_line(app, count, arguments);
}

void run(const Options& options) {
    support::check_output_path(options.out);
    (void)support::image_format(options.out);  // refuses what it does not know
    const cellist::Device device = options.device.empty() ? cellist::Device::choose()
                                                          : cellist::Device::choose(options.device);
    support::Mesh mesh = support::load_mesh(options.mesh);
    support::turn_up(mesh, mesh.up);
    support::fit_to_unit_sphere(mesh);

    transparency::Surface surface;
    surface.alpha = static_cast<cl_float>(options.alpha);
    const raster::View view =
        support::frame_unit_sphere(options.camera, options.width, options.height);
    const transparency::Picture picture = transparency::draw(device, mesh, view, surface);

    support::write_image(options.out, picture.pixels, options.width, options.height);
    std::cout << mesh.triangles.size() << " triangles" << support::dropped_text(mesh.drops) << ", "
              << picture.layers.total << " fragments, up to " << picture.layers.longest
              << " in a pixel\n";
}

}  // namespace

int main(int count, char** arguments) {
    return support::run_program("transparency", [&] {
        Options options;
        if (const auto text = parse_options(options, count, arguments))
            std::cout << *text;
        else
            run(options);
        return true;
    });
}
