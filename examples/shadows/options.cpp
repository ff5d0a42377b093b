// SPDX-License-Identifier: MIT
#include "options.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string_view>

#include <glm/geometric.hpp>

#include "camera_options.hpp"
#include "closest.hpp"
#include "command_line.hpp"
#include "files.hpp"
#include "image.hpp"
#include "input_error.hpp"
#include "number_text.hpp"
#include "raster/rasteriser.hpp"

namespace shadows {
namespace {

constexpr int samples_max = 128, reduce_max = 64, simplify_max = 1024;
constexpr std::size_t triangles_min = 784, triangles_max = 10'000'000;  // a ring has 784

using Text = const std::string&;

glm::dvec3 read_position(Text text) {
    glm::dvec3 position(0);
    std::string_view rest(text);
    for (int k = 0; k < 3; ++k) {
        const auto [end, error] = std::from_chars(rest.begin(), rest.end(), position[k]);
        const bool is_last = k == 2;
        if (error != std::errc() || !(std::abs(position[k]) <= 1000) ||
            (is_last ? end != rest.end() : end == rest.end() || *end != ','))
            support::refuse("--light-position", text, "X,Y,Z from -1000 to 1000");
        rest.remove_prefix(static_cast<std::size_t>(end - rest.begin()) + (is_last ? 0 : 1));
    }
    return position;
}

void add_scene_options(support::CommandLine& line, Options& options) {
    Settings& settings = options.settings;
    line.add_text("scene", options.scene,
                  "room, swarm (moving rings), or a mesh file (PLY, OBJ, glTF, STL, OFF, ...)",
                  "SCENE");
    line.add_number("--triangles", options.triangles, triangles_min, triangles_max,
                    "triangles of the swarm");
    line.add("--light", "spot", "kind of light", "spot|directional", [&](Text text) {
        if (text != "spot" && text != "directional")
            support::refuse("--light", text, "spot or directional");
        options.parallel_light = text == "directional";
    });
    line.add("--light-position", "",
             "where the light is, in metres; the room is 3 x 2 x 2 around 0,0,0", "X,Y,Z",
             [&](Text text) { options.light_position = read_position(text); });
    support::add_view(line, "", [&](const support::Orbit& view) { options.view = view; });
    support::add_zoom(line, options.zoom);
    line.add_real("--time", options.time, -1e6, 1e6, "time of the first frame, in seconds", "T");
    line.add_number("--width", settings.width, 1, RASTER_SIDE_MAX, "width in pixels");
    line.add_number("--height", settings.height, 1, RASTER_SIDE_MAX, "height in pixels");
}

void add_quality_options(support::CommandLine& line, Settings& settings) {
    line.add_number("--rsm", settings.rsm, 1, RASTER_SIDE_MAX,
                    "texels of the reflective shadow map along each axis");
    line.add_number("--samples", settings.samples, 1, samples_max,
                    "parts of the shadow map along each axis that light the scene; divides --rsm");
    line.add_number("--reduce", settings.reduce, 1, reduce_max,
                    "draw buffer B (blocked light) with 1/N of the width and height");
    line.add_number("--interleave", settings.interleave, 1, samples_max,
                    "share out the samples among N x N pixels of B; divides --samples");
    line.add(
        "--grid", "auto", "cells of the grid along its longest side", "N|auto", [&](Text text) {
            settings.grid =
                text == "auto"
                    ? 0
                    : static_cast<int>(support::read_number("--grid", text, 1, GRID_EXTENT_MAX));
        });
    line.add("--simplify", "off",
             "merge vertices of blockers in N cells along the longest side of their mesh", "N|off",
             [&](Text text) {
                 settings.simplify = text == "off" ? 0
                                                   : static_cast<int>(support::read_number(
                                                         "--simplify", text, 1, simplify_max));
             });
    line.add_storage(settings.storage);
}

void add_output_options(support::CommandLine& line, Options& options) {
    line.add_number("--frames", options.frames, 1, 1'000'000,
                    "timed frames, after a warm-up; times are medians");
    line.add_real("--time-step", options.time_step, 0, 1000,
                  "time between frames of a moving scene, in seconds", "S");
    line.add("--out", options.out.path().string(),
             "picture to write: .png, .jpg, .pfm or .exr, - for stdout; all frames as "
             "frame-%04d.png",
             "FILE", [&](Text text) { options.out = support::PictureName(text); });
    line.add_text("--out-unblocked", options.out_unblocked,
                  "write the picture without indirect shadows", "FILE");
    line.add_text("--out-a", options.out_a, "write buffer A: all indirect light", "FILE");
    line.add_text("--out-b", options.out_b, "write buffer B: blocked indirect light", "FILE");
    line.add_text("--heatmap", options.heatmap,
                  "write a heat map of the list entries that rays from the eye pass", "FILE");
    line.add_flag("--reference", options.reference,
                  "compare with the same light in double precision on the CPU; exit code 1 if a "
                  "ray's answer differs");
    line.add_text("--out-error", options.out_error,
                  "write a heat map of the error against that reference", "FILE");
    line.add_text("--json", options.json, "write times, counts and errors to this file", "FILE");
    line.add_flag("--trade", options.trade, "compare settings: error against time, as a table");
    line.add_device(options.device);
}

void check(const support::CommandLine& line, const Options& options) {
    const support::NamedFile outputs[] = {
        {"--out", options.out.of(1)},   {"--out-unblocked", options.out_unblocked},
        {"--out-a", options.out_a},     {"--out-b", options.out_b},
        {"--heatmap", options.heatmap}, {"--out-error", options.out_error},
        {"--json", options.json}};
    std::vector<support::NamedFile> inputs;
    if (options.scene != "room" && options.scene != "swarm")
        inputs.push_back({"the mesh", options.scene});
    support::check_outputs(std::move(inputs), outputs);
    for (const auto& [name, path] : outputs)
        if (!path.empty() && std::string_view(name) != "--json") (void)support::image_format(path);
    const bool is_swarm = options.scene == "swarm";
    const support::IdleOption table[] = {
        {"--triangles", !is_swarm, "--triangles is for the scene swarm"},
        {"--time", !is_swarm, "--time is for the scene swarm: nothing else moves"},
        {"--time-step", !is_swarm, "--time-step is for the scene swarm: nothing else moves"},
        {"--reference", options.trade, "--trade compares pictures itself: leave out --reference"},
        {"--out", options.trade, "--trade writes no picture: leave out --out"},
        {"--out-unblocked", options.trade, "--trade writes no picture: leave out --out-unblocked"},
        {"--out-a", options.trade, "--trade writes no picture: leave out --out-a"},
        {"--out-b", options.trade, "--trade writes no picture: leave out --out-b"},
        {"--heatmap", options.trade, "--trade writes no picture: leave out --heatmap"},
        {"--out-error", options.trade, "--trade writes no picture: leave out --out-error"},
        {"--time-step", options.trade, "--trade draws one moment: leave out --time-step"},
    };
    line.refuse_idle(table);
    check_settings(options.settings);
}

}  // namespace

bool Options::writes_to_stdout() const {
    return std::ranges::any_of(
        std::array{out.of(1), out_unblocked, out_a, out_b, heatmap, out_error, json},
        support::is_standard_output);
}

Options parse_options(int count, const char* const* arguments) {
    Options options;
    support::CommandLine line("cellist-shadows",
                              "Draws a scene with one bounce of indirect light, and its shadows by "
                              "rays through a grid of triangle lists.");
    add_scene_options(line, options);
    add_quality_options(line, options.settings);
    add_output_options(line, options);
    line.add_check([&] { check(line, options); });
    options.help_text = line.parse(count, arguments).value_or("");
    options.arguments.assign(arguments + 1, arguments + count);
    options.reference = options.reference || !options.out_error.empty();
    return options;
}

Scene make_scene(const Options& options) {
    const auto make = [&] {
        if (options.scene == "room") return make_room();
        if (options.scene == "swarm") return make_swarm(options.triangles);
        std::error_code error;
        const std::array<std::string, 2> names{"room", "swarm"};
        if (!std::filesystem::exists(options.scene, error))
            throw support::InputError("'" + support::text_of(options.scene) +
                                      "' is neither a scene (room, swarm) nor a file" +
                                      support::did_you_mean(options.scene, names));
        support::Mesh mesh = support::load_mesh(options.scene);
        support::turn_up(mesh, mesh.up);
        return make_mesh_room(std::move(mesh));
    };
    Scene scene = make();
    if (options.parallel_light) scene.light = make_parallel_light();
    if (options.light_position) {
        scene.light.position = *options.light_position;
        if (glm::length(scene.light.target - scene.light.position) < 1e-3)
            throw support::InputError("--light-position is where the light shines to: move it");
    }
    scene.eye = support::moved_eye(scene.eye, scene.target, options.view, options.zoom);
    if (scene.move) scene.move(scene, options.time);
    return scene;
}

}  // namespace shadows
