// SPDX-License-Identifier: MIT
#include "options.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "build.hpp"
#include "camera_options.hpp"
#include "closest.hpp"
#include "command_line.hpp"
#include "files.hpp"
#include "image.hpp"
#include "input_error.hpp"
#include "measure.hpp"
#include "number_text.hpp"
#include "raster/rasteriser.hpp"

namespace motion {
namespace {

constexpr std::array<const char*, 4> scene_names{"cubes", "walker", "fan", "blinds"};
constexpr std::size_t triangles_min = 12'000, triangles_max = 1'000'000;
constexpr cl_uint samples_max = 10'000, moments_max = 1'000'000;
constexpr double exposure_max = 4, bias_max = 100, tolerance_max = 100;

using Text = const std::string&;

bool is_scene(const std::string& name) {
    return std::ranges::find(scene_names, name) != scene_names.end();
}

glm::dvec3 read_move(Text text) {
    glm::dvec3 move(0);
    const char* rest = text.data();
    const char* const end = text.data() + text.size();
    for (int k = 0; k < 3; ++k) {
        const auto [after, error] = std::from_chars(rest, end, move[k]);
        if (error != std::errc() || (k == 2 ? after != end : after == end || *after != ','))
            support::refuse("--move", text, "X,Y,Z in metres, such as 0,0.3,0");
        rest = after + 1;
    }
    return move;
}

void add_switch(support::CommandLine& line, const std::string& name, bool& value,
                const std::string& what) {
    line.add(name, value ? "on" : "off", what, "on|off", [&value, name](Text text) {
        if (text != "on" && text != "off") support::refuse(name, text, "on or off");
        value = text == "on";
    });
}

void add_texels(support::CommandLine& line, const std::string& name, cl_float& value, double most,
                const std::string& what) {
    line.add(name, support::shortest(value), what, "TEXELS", [&value, name, most](Text text) {
        value = static_cast<cl_float>(support::read_between(
            name, text, 0, most, "a number from 0 to " + support::shortest(most)));
    });
}

void add_scene_options(support::CommandLine& line, Options& options) {
    Settings& settings = options.settings;
    line.add_text("scene", options.scene,
                  "cubes, walker, fan, blinds, or a mesh file (PLY, OBJ, glTF, STL, OFF, ...)",
                  "SCENE");
    line.add_number("--triangles", options.triangles, triangles_min, triangles_max,
                    "triangles of the walker");
    line.add("--move", "", "how far a mesh moves, in metres; its largest side is 1 m long", "X,Y,Z",
             [&](Text text) { options.motion.move = read_move(text); });
    line.add_real("--spin", options.motion.spin_degrees, -360, 360,
                  "how far a mesh turns about the vertical", "DEGREES");
    line.add_real("--exposure", options.exposure, 0, exposure_max,
                  "scale the motion: 0 stops it, 1 leaves it as it is", "E");
    line.add("--light", "spot", "kind of light", "spot|directional", [&](Text text) {
        if (text != "spot" && text != "directional")
            support::refuse("--light", text, "spot or directional");
        options.parallel_light = text == "directional";
    });
    support::add_view(line, "", [&](const support::Orbit& view) { options.view = view; });
    support::add_zoom(line, options.zoom);
    line.add_number("--width", settings.width, 1, RASTER_SIDE_MAX, "width in pixels");
    line.add_number("--height", settings.height, 1, RASTER_SIDE_MAX, "height in pixels");
}

void add_method_options(support::CommandLine& line, Options& options) {
    Settings& settings = options.settings;
    std::string names;
    for (const NamedMethod& method : methods) names += std::string(method.name) + "|";
    line.add("--method", options.method, "method of the shadows", names + "all",
             [&options](Text text) {
                 std::vector<std::string> known{"all"};
                 for (const NamedMethod& method : methods) known.emplace_back(method.name);
                 if (std::ranges::find(known, text) == known.end())
                     throw support::InputError("--method " + text + ": see --help for the methods" +
                                               support::did_you_mean(text, known));
                 options.method = text;
             });
    line.add_number("--samples", settings.samples, 0, samples_max,
                    "samples of each pixel, each at its own time; with 0 the picture is black");
    line.add_number("--times", options.moments, 1, moments_max,
                    "moments of accumulate, which is also the reference");
    line.add_number("--shadow-map", settings.shadow_map, 1, RASTER_SIDE_MAX,
                    "texels of the shadow map along each axis");
    add_texels(line, "--bias", settings.bias, bias_max, "depth bias of shadow tests");
    add_switch(line, "--prepass", settings.prepass,
               "build only what the shadow tests of the picture can read");
    add_switch(line, "--insides", settings.insides,
               "keep the insides of closed surfaces in shadow maps, as the paper does");
    add_switch(line, "--compress", settings.compress, "merge the ranges of exact");
    add_texels(line, "--tolerance", settings.tolerance, tolerance_max,
               "largest error of depth in merged ranges");
    line.add("--memory", "",
             "limit on the device memory of the ranges of exact, such as 64MiB; they are built in "
             "slices",
             "BYTES",
             [&](Text text) { settings.budget_bytes = support::read_bytes("--memory", text); });
    line.add_storage(settings.storage);
}

void add_output_options(support::CommandLine& line, Options& options) {
    line.add_number("--frames", options.frames, 1, 1'000'000,
                    "timed frames, after two that warm up; times are medians");
    line.add_flag("--reference", options.reference,
                  "compare with accumulate: PSNR, SSIM, and pixels that shadow themselves");
    line.add_flag("--trade", options.trade,
                  "compare all methods with 8, 16, 20, 32 and 64 samples, as a table");
    line.add_text("--out", options.out,
                  "picture to write: .png, .jpg, .pfm or .exr, - for stdout; of all methods as "
                  "NAME-METHOD.png",
                  "FILE");
    line.add_text("--out-shadow", options.out_shadow,
                  "write the part of the samples that are in shadow", "FILE");
    line.add_text("--out-difference", options.out_difference,
                  "write the difference from the reference, 16 times as large", "FILE");
    line.add_text("--out-reference", options.out_reference, "write the reference", "FILE");
    line.add_text("--json", options.json, "write times, memory and errors to this file", "FILE");
    line.add_text("--csv", options.csv, "write a table with a line for each method", "FILE");
    line.add_text("--html", options.html, "write a page with pictures, tables and plots", "FILE");
    line.add_device(options.device);
}

void check(const support::CommandLine& line, Options& options) {
    const support::NamedFile pictures[] = {{"--out", options.out},
                                           {"--out-shadow", options.out_shadow},
                                           {"--out-difference", options.out_difference},
                                           {"--out-reference", options.out_reference}};
    std::vector<support::NamedFile> outputs(std::begin(pictures), std::end(pictures));
    outputs.insert(outputs.end(),
                   {{"--json", options.json}, {"--csv", options.csv}, {"--html", options.html}});
    std::vector<support::NamedFile> inputs;
    const bool is_mesh = !is_scene(options.scene);
    if (is_mesh) inputs.push_back({"the mesh", options.scene});
    support::check_outputs(std::move(inputs), outputs);
    for (const auto& [name, path] : pictures)
        if (!path.empty()) (void)support::image_format(path);
    options.reference = options.reference || options.trade || !options.out_difference.empty() ||
                        !options.out_reference.empty() || !options.html.empty();
    const auto idle = [&](const char* name, bool applies, const std::string& why) {
        return support::IdleOption{name, applies, std::string(name) + why};
    };
    const auto not_in_trade = [&](const char* name, const char* why) {
        return idle(name, options.trade, std::string(": --trade ") + why + ": leave it out");
    };
    const support::IdleOption table[] = {
        idle("--triangles", options.scene != "walker", " is for the scene walker"),
        idle("--move", !is_mesh, " is for a mesh file"),
        idle("--spin", !is_mesh, " is for a mesh file"),
        idle("--times", !options.reference && !options.shows("accumulate"),
             " is for --reference or --method accumulate"),
        idle("--compress", !options.shows("exact"), " is for --method exact"),
        idle("--memory", !options.shows("exact"), " is for --method exact"),
        idle("--tolerance", !options.shows("exact") || !options.settings.compress,
             " is for --method exact with --compress on"),
        idle("--html", options.method == reference_name,
             " compares methods with accumulate: give another --method"),
        not_in_trade("--method", "draws all methods"),
        not_in_trade("--samples", "sets the samples itself"),
        not_in_trade("--out", "writes no picture but those of --html"),
        not_in_trade("--out-shadow", "writes no picture but those of --html"),
        not_in_trade("--out-difference", "writes no picture but those of --html"),
    };
    line.refuse_idle(table);
    if (options.trade) options.method = "all";
}

Scene scene_of(const Options& options) {
    if (options.scene == "cubes") return make_cubes();
    if (options.scene == "walker") return make_walker(options.triangles);
    if (options.scene == "fan") return make_fan();
    if (options.scene == "blinds") return make_blinds();
    std::error_code error;
    if (!std::filesystem::exists(options.scene, error)) {
        const std::vector<std::string> names(scene_names.begin(), scene_names.end());
        throw support::InputError("'" + support::text_of(options.scene) +
                                  "' is neither a scene (cubes, walker, fan, blinds) nor a file" +
                                  support::did_you_mean(options.scene, names));
    }
    support::Mesh mesh = support::load_mesh(options.scene);
    support::turn_up(mesh, mesh.up);
    return make_mesh_scene(mesh, options.motion);
}

}  // namespace

bool Options::writes_to_stdout() const {
    return std::ranges::any_of(
        std::array{out, out_shadow, out_difference, out_reference, json, csv, html},
        support::is_standard_output);
}

bool Options::shows(std::string_view name) const { return method == "all" || method == name; }

Options parse_options(int count, const char* const* arguments) {
    Options options;
    support::CommandLine line("cellist-motion-shadows",
                              "Draws a moving scene with motion-blurred shadows from depth-time "
                              "ranges, and compares with other methods.");
    add_scene_options(line, options);
    add_method_options(line, options);
    add_output_options(line, options);
    line.add_check([&] { check(line, options); });
    options.help_text = line.parse(count, arguments).value_or("");
    options.arguments.assign(arguments + 1, arguments + count);
    return options;
}

Scene make_scene(const Options& options) {
    Scene scene = scene_of(options);
    if (options.exposure != 1) expose(scene, options.exposure);
    if (options.parallel_light) make_light_parallel(scene);
    scene.eye = support::moved_eye(scene.eye, scene.target, options.view, options.zoom);
    return scene;
}

}  // namespace motion
