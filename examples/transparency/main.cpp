// SPDX-License-Identifier: MIT
// Order-independent transparency with one list per pixel: the whole of it.
#include <iostream>
#include <optional>
#include <string>

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
    support::CommandLine line("transparency", "Draws a mesh whose every surface is transparent.");
    line.add_text("mesh", options.mesh, "mesh file (PLY, OBJ, glTF, STL, OFF, ...)", "MESH");
    line.add_text("--out", options.out, "picture to write: .png, .jpg, .pfm or .exr", "FILE");
    line.add_real("--alpha", options.alpha, 0, 1, "opacity of a surface that faces the eye", "A");
    line.add_number("--width", options.width, 1, RASTER_SIDE_MAX, "width in pixels");
    line.add_number("--height", options.height, 1, RASTER_SIDE_MAX, "height in pixels");
    line.add_real("--azimuth", options.camera.azimuth_degrees, -1e6, 1e6,
                  "azimuth of the camera, in degrees", "DEGREES");
    line.add_real("--elevation", options.camera.elevation_degrees, -90, 90,
                  "elevation of the camera, in degrees", "DEGREES");
    line.add_device(options.device);
    line.add_check([&] {
        if (options.mesh.empty()) throw support::InputError("no mesh given (see --help)");
    });
    return line.parse(count, arguments);
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
