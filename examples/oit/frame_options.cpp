// SPDX-License-Identifier: MIT
#include "frame_options.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>
#include <utility>

#include "camera_options.hpp"
#include "closest.hpp"
#include "command_line.hpp"
#include "files.hpp"
#include "input_error.hpp"
#include "mesh.hpp"
#include "methods/method.hpp"
#include "number_text.hpp"
#include "raster/rasteriser.hpp"
#include "read_file.hpp"
#include "scene/scenes.hpp"

namespace oit {
namespace {

using support::InputError;
using support::refuse;

// Of --lens.
constexpr double lens_radius_max = 100;
constexpr double lens_focus_min = 1e-6;

// The whole text as a number, or nothing.
template <class T>
std::optional<T> parse(std::string_view text) {
    T value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) return {};
    return value;
}

void read_size(const std::string& text, FrameOptions& options) {
    const std::string expected =
        "--size " + text + ": expected WIDTHxHEIGHT in pixels, such as 1280x720";
    const std::size_t x = text.find('x');
    if (x == std::string::npos) throw InputError(expected);
    const auto width = parse<long long>(std::string_view(text).substr(0, x));
    const auto height = parse<long long>(std::string_view(text).substr(x + 1));
    if (!width || !height) throw InputError(expected);
    if (*width < 1 || *height < 1)
        throw InputError("--size " + text + ": each side has at least 1 pixel");
    constexpr long long int_max = 0x7FFFFFFF;
    if (*width > int_max || *height > int_max)
        throw InputError("--size " + text + ": each side has at most " +
                         std::to_string(RASTER_SIDE_MAX) + " pixels");
    options.width = static_cast<int>(*width);
    options.height = static_cast<int>(*height);
}

void read_samples(const std::string& text, FrameOptions& options) {
    options.all_samples = text == "all";
    if (text == "exact" || options.all_samples) {
        options.quality.samples = 1;
        options.quality.coverage = Coverage::exact;
        return;
    }
    const auto samples = parse<int>(text);
    if (!samples || (*samples != 1 && *samples != 2 && *samples != 4 && *samples != 8))
        refuse("--samples", text, "1, 2, 4, 8 or exact");
    options.quality.samples = *samples;
    options.quality.coverage = Coverage::samples;
}

void read_lens(const std::string& text, FrameOptions& options) {
    if (text.empty()) return;
    const std::size_t comma = text.find(',');
    const auto radius = parse<double>(std::string_view(text).substr(0, comma));
    const auto focus = comma == std::string::npos
                           ? std::nullopt
                           : parse<double>(std::string_view(text).substr(comma + 1));
    if (!radius || !focus || std::isnan(*focus))
        refuse("--lens", text, "RADIUS,FOCUS, such as 0.1,4 or 0.1,inf");
    if (!(*radius >= 0 && *radius <= lens_radius_max))
        throw InputError("--lens " + text + ": the radius must be from 0 to " +
                         support::shortest(lens_radius_max) + "; the scene has radius 1");
    if (!(std::abs(*focus) >= lens_focus_min))
        throw InputError("--lens " + text + ": the focus must be at least " +
                         support::shortest(lens_focus_min) + " from the eye");
    options.lens = Lens{*radius, *focus};
}

std::string lens_text(const std::optional<Lens>& lens) {
    return lens ? support::shortest(lens->radius) + "," + support::shortest(lens->focus) : "";
}

void read_resolve(const std::string& text, FrameOptions& options) {
    if (text != "pixel" && text != "sample") refuse("--resolve", text, "pixel or sample");
    options.quality.resolve = text == "pixel" ? Resolve::per_pixel : Resolve::per_sample;
}

void read_depth_scale(const std::string& text, FrameOptions& options) {
    if (text != "linear" && text != "reversed") refuse("--depth-scale", text, "linear or reversed");
    options.quality.depth_scale = text == "linear" ? DepthScale::linear : DepthScale::reversed;
}

constexpr std::pair<std::string_view, Blend> blend_kinds[] = {
    {"over", Blend::over},
    {"additive", Blend::additive},
    {"multiplicative", Blend::multiplicative},
    {"absorb", Blend::absorb},
};

// A kind of blending, or a file with a function.
void read_blend(const std::string& text, FrameOptions& options) {
    if (text.empty()) return;
    for (const auto& [name, blend] : blend_kinds)
        if (text == name) {
            options.blend = blend;
            return;
        }
    constexpr std::size_t most_bytes = 1 << 20;
    std::error_code error;
    if (!std::filesystem::exists(text, error))
        refuse("--blend", text,
               "over, additive, multiplicative, absorb, or a file with an OpenCL C function");
    std::string function = support::read_file("--blend file", text, most_bytes);
    if (function.find('\0') != std::string::npos)
        throw InputError("--blend " + support::text_of(text) +
                         ": not a text file: it has a byte of 0");
    // Other text comes before it, and a byte order mark may only start a source.
    if (function.starts_with("\xEF\xBB\xBF")) function.erase(0, 3);
    options.blend = Blend::user;
    options.blend_function = {std::move(function), text};
}

std::optional<support::UpAxis> read_up(const std::string& text) {
    if (text.empty()) return {};
    if (text == "x") return support::UpAxis::x;
    if (text == "y") return support::UpAxis::y;
    if (text == "z") return support::UpAxis::z;
    refuse("--up", text, "x, y or z");
}

std::vector<std::string> arguments_of(const FrameOptions& options) {
    std::vector<std::string> arguments{options.scene};
    arguments.insert(arguments.end(), options.more_meshes.begin(), options.more_meshes.end());
    return arguments;
}

Scene scene_of_files(const FrameOptions& options) {
    std::vector<MeshFile> files;
    for (const std::string& argument : arguments_of(options)) files.push_back(mesh_file(argument));
    std::vector<PlacedMesh> placed;
    std::vector<support::Mesh*> meshes;
    std::vector<SceneMesh> origins;
    placed.reserve(files.size());
    for (const MeshFile& file : files) {
        placed.push_back({.mesh = support::load_mesh(file.path),
                          .alpha = options.alpha,
                          .own_alpha = file.alpha});
        support::Mesh& mesh = placed.back().mesh;
        support::turn_up(mesh, options.up.value_or(mesh.up));
        meshes.push_back(&mesh);
        origins.push_back({.file = support::text_of(file.path),
                           .alpha = file.alpha,
                           .triangles = mesh.triangles.size(),
                           .ignored_textures = mesh.ignored_textures,
                           .ends_within_line = mesh.ends_within_line,
                           .drops = mesh.drops,
                           .notes = mesh.notes});
    }
    support::fit_to_unit_sphere(meshes);
    Scene scene = scene_of(std::move(placed));
    scene.meshes = std::move(origins);
    return scene;
}

void set_blend(Scene& scene, Blend blend) {
    for (Material& material : scene.materials)
        if (material.blend != static_cast<cl_uint>(Blend::opaque))
            material.blend = static_cast<cl_uint>(blend);
}

std::string meant_scene(const std::string& text) {
    std::vector<std::string> names;
    for (const SceneInfo& info : scenes()) names.emplace_back(info.name);
    return support::did_you_mean(text, names);
}

void check_scene(const FrameOptions& options) {
    const std::vector<std::string> arguments = arguments_of(options);
    for (const std::string& argument : arguments) {
        const SceneInfo* scene = find_scene(argument.substr(0, argument.rfind(':')));
        if (find_scene(argument) != nullptr && arguments.size() > 1)
            throw InputError("the scene '" + argument +
                             "' is drawn alone: leave out the other meshes and scenes");
        std::error_code error;
        if (scene != nullptr && scene->name != argument &&
            !std::filesystem::exists(argument, error) &&
            !std::filesystem::exists(std::string(scene->name), error))
            throw InputError("'" + argument + "': the scene " + std::string(scene->name) +
                             " takes its opacity from --alpha");
    }
    if (options.up && find_scene(options.scene) != nullptr)
        throw InputError("--up turns mesh files, and '" + options.scene + "' is a scene");
}

void refuse_idle_options(const support::CommandLine& line, const FrameOptions& options) {
    const bool one_sample = options.quality.samples == 1;
    const bool is_exact = options.quality.coverage == Coverage::exact;
    const SceneInfo* scene = find_scene(options.scene);
    const support::IdleOption idle[] = {
        {"--lens", is_exact || !one_sample,
         "--lens draws one sample per pixel: leave out --samples"},
        {"--depth-range", is_exact,
         "--depth-range is for samples, and --samples exact has none: leave one of them out"},
        {"--resolve", is_exact,
         "--resolve is for samples, and --samples exact has none: leave one of them out"},
        {"--depth-range", one_sample,
         "--depth-range needs several samples: add --samples 2, 4 or 8"},
        {"--alpha", scene != nullptr && !scene->takes_alpha,
         "--alpha: the surfaces of '" + options.scene + "' have opacities of their own"},
        {"--resolve", one_sample, "--resolve needs several samples: add --samples 2, 4 or 8"},
    };
    line.refuse_idle(idle);
}

}  // namespace

std::string blend_text(const FrameOptions& options) {
    if (options.blend_function) return options.blend_function->file_name;
    for (const auto& [name, blend] : blend_kinds)
        if (options.blend == blend) return std::string(name);
    return {};
}

void check_outputs(const FrameOptions& options, std::span<const support::NamedFile> outputs) {
    std::vector<support::NamedFile> inputs;
    if (find_scene(options.scene) == nullptr)
        for (const std::string& argument : arguments_of(options))
            inputs.push_back({"the mesh", mesh_file(argument).path});
    if (options.blend_function) inputs.push_back({"--blend", options.blend_function->file_name});
    support::check_outputs(std::move(inputs), outputs);
}

std::string help_on_tables() {
    std::string text = "Methods:\n";
    const auto line = [&](std::string_view name, std::string_view summary) {
        text += "  " + std::string(name) +
                std::string(name.size() < 24 ? 24 - name.size() : 1, ' ') + std::string(summary) +
                "\n";
    };
    for (const MethodInfo& info : methods()) {
        std::string name(info.name);
        if (!info.sizes.empty())
            name += "[:" + std::to_string(info.sizes.front()) + "..." +
                    std::to_string(info.sizes.back()) + "]";
        line(name, info.summary);
    }
    text += "Scenes:\n";
    for (const SceneInfo& info : scenes()) line(info.name, info.summary);
    return text;
}

void add_frame_options(support::CommandLine& line, FrameOptions& options) {
    using Text = const std::string&;
    line.add_arguments("scene",
                       "mesh files (OBJ, PLY, STL, glTF, ...), each with an opacity of its own if "
                       "ALPHA is given; or a scene",
                       "MESH[:ALPHA]...|SCENE", [&](const std::vector<std::string>& arguments) {
                           if (arguments.empty())
                               throw InputError("no mesh or scene given (see --help)");
                           options.scene = arguments.front();
                           options.more_meshes.assign(arguments.begin() + 1, arguments.end());
                       });
    line.add("--size", std::to_string(options.width) + "x" + std::to_string(options.height),
             "image size in pixels", "WxH", [&](Text text) { read_size(text, options); });
    line.add("--alpha", support::shortest(options.alpha),
             "opacity of surfaces whose file gives none, 0 to 1", "A", [&](Text text) {
                 options.alpha = static_cast<float>(
                     support::read_between("--alpha", text, 0, 1, "a number from 0 to 1"));
             });
    line.add("--up", "",
             "axis that points up in the mesh files: x, y or z; by default, each file or its "
             "format decides",
             "AXIS", [&](Text text) { options.up = read_up(text); });
    line.add("--blend", blend_text(options),
             "how surfaces blend: over, additive, multiplicative, absorb, or a file with a "
             "function",
             "KIND|FILE", [&](Text text) { read_blend(text, options); });
    line.add("--samples", std::to_string(options.quality.samples),
             "samples per pixel: 1, 2, 4 or 8; or exact, for the area that each triangle covers",
             "N|exact", [&](Text text) { read_samples(text, options); });
    line.add("--resolve", options.quality.resolve == Resolve::per_pixel ? "pixel" : "sample",
             "where samples are blended: pixel or sample", "WHERE",
             [&](Text text) { read_resolve(text, options); });
    line.add_flag("--depth-range", options.quality.depth_range,
                  "order surfaces that meet within a pixel by their depths in each sample");
    line.add("--depth-scale",
             options.quality.depth_scale == DepthScale::linear ? "linear" : "reversed",
             "stored depth: linear (the depth) or reversed (1 / depth)", "S",
             [&](Text text) { read_depth_scale(text, options); });
    support::add_view(line, support::view_text(options.orbit),
                      [&](const support::Orbit& view) { options.orbit = view; });
    support::add_zoom(line, options.orbit.zoom);
    line.add("--stereo", options.eye_separation ? support::shortest(*options.eye_separation) : "",
             "draw two eyes at this distance; the scene has radius 1", "DISTANCE", [&](Text text) {
                 options.eye_separation =
                     support::read_between("--stereo", text, 0, 1, "a distance from 0 to 1");
             });
    line.add("--lens", lens_text(options.lens),
             "depth of field: radius of the aperture, and depth in focus; the scene has radius 1",
             "RADIUS,FOCUS", [&](Text text) { read_lens(text, options); });
    line.add("--time", support::shortest(options.time), "time of an animated scene, in seconds",
             "T", [&](Text text) {
                 options.time = support::read_between("--time", text, -1e6, 1e6,
                                                      "seconds from -1000000 to 1000000");
             });
    line.add_flag("--opaque-floor", options.opaque_floor, "stand the scene on an opaque floor");
    line.add_device(options.device);
    line.add_check([&] {
        check_scene(options);
        refuse_idle_options(line, options);
    });
}

// The largest buffers of a frame: image and opaque colour with 16 bytes a sample.
void check_size(const FrameOptions& options, const cellist::Device& device) {
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

cellist::Device choose_device(const FrameOptions& options) {
    cellist::Device device = options.device.empty() ? cellist::Device::choose()
                                                    : cellist::Device::choose(options.device);
    check_size(options, device);
    return device;
}

MeshFile mesh_file(const std::string& text) {
    std::error_code error;
    const auto exists = [&](const std::string& path) {
        return std::filesystem::exists(path, error);
    };
    const std::size_t colon = text.rfind(':');
    if (exists(text)) return {text, {}};
    if (colon == std::string::npos || !exists(text.substr(0, colon)))
        throw InputError("'" + support::text_of(text) + "' is neither a file nor a scene" +
                         meant_scene(text) + "; --help lists the scenes");
    const auto alpha = parse<float>(std::string_view(text).substr(colon + 1));
    if (!alpha || !(*alpha >= 0 && *alpha <= 1))
        throw InputError("'" + text +
                         "': expected an opacity from 0 to 1 after the colon, such as " +
                         text.substr(0, colon) + ":0.3");
    return {text.substr(0, colon), alpha};
}

std::string title_of(const FrameOptions& options) {
    std::string title;
    for (const std::string& argument : arguments_of(options))
        title += (title.empty() ? "" : " + ") +
                 support::text_of(std::filesystem::path(argument).filename());
    return title;
}

bool sees_floor(const Scene& scene, const FrameOptions& options) {
    return options.opaque_floor &&
           std::ranges::any_of(make_views(options), [&](const raster::View& view) {
               return view.eye[1] > scene.lighting.floor_height;
           });
}

void stand_on_floor(Scene& scene, const FrameOptions& options) {
    if (sees_floor(scene, options)) add_floor(scene);
}

Scene make_scene(const FrameOptions& options) {
    const SceneInfo* info = find_scene(options.scene);
    Scene scene = info != nullptr ? info->make(options.alpha) : scene_of_files(options);
    if (options.blend) set_blend(scene, *options.blend);
    if (options.time != 0) require_motion(scene, options, "--time");
    return scene;
}

bool moves(const Scene& scene) {
    return std::ranges::any_of(
        scene.instances, [](const Instance& instance) { return instance.turns_per_second != 0; });
}

void require_motion(const Scene& scene, const FrameOptions& options, const std::string& option) {
    if (!moves(scene))
        throw InputError(option + ": nothing moves in '" + support::text_of(options.scene) +
                         "', so leave it out");
}

std::vector<raster::View> make_views(const FrameOptions& options) {
    if (options.eye_separation)
        return support::frame_unit_sphere(options.orbit, options.width, options.height,
                                          *options.eye_separation);
    return {support::frame_unit_sphere(options.orbit, options.width, options.height)};
}

Frame make_frame(const Scene& scene, const FrameOptions& options) {
    return {.scene = scene,
            .views = make_views(options),
            .time = options.time,
            .quality = options.quality,
            .blend_function = options.blend_function,
            .lens = options.lens};
}

}  // namespace oit
