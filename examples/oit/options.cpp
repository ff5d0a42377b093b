#include "options.hpp"

#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>

#include "command_line.hpp"
#include "input_error.hpp"
#include "method.hpp"
#include "scenes.hpp"

namespace oit {
namespace {

using support::InputError;
using support::refuse;

// The whole text as a number, or nothing.
template <class T>
std::optional<T> parse(std::string_view text) {
    T value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) return {};
    return value;
}

// A number between bounds that belong to it.
double read_between(const std::string& option, const std::string& text, double least, double most,
                    const std::string& expected) {
    const auto value = parse<double>(text);
    if (!value || !(*value >= least && *value <= most)) refuse(option, text, expected);
    return *value;
}

void read_size(const std::string& text, Options& options) {
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

void read_layers(const std::string& text, Options& options) {
    if (text == "all") return;
    const auto layers = parse<long long>(text);
    if (!layers || *layers < 1 || *layers > 0xFFFFFFFF)
        refuse("--layers", text, "'all' or a number from 1 to 4294967295");
    options.quality.layers = static_cast<std::uint32_t>(*layers);
}

void read_view(const std::string& text, Options& options) {
    const std::size_t comma = text.find(',');
    const auto azimuth = parse<double>(std::string_view(text).substr(0, comma));
    const auto elevation = comma == std::string::npos
                               ? std::nullopt
                               : parse<double>(std::string_view(text).substr(comma + 1));
    if (!azimuth || !elevation || !std::isfinite(*azimuth) || !std::isfinite(*elevation))
        refuse("--view", text, "AZIMUTH,ELEVATION in degrees, such as 25,8");
    if (std::abs(*elevation) > 90)
        throw InputError("--view " + text + ": the elevation lies between -90 and 90");
    options.orbit = {.azimuth_degrees = std::fmod(*azimuth, 360.0),
                     .elevation_degrees = *elevation};
}

void read_samples(const std::string& text, Options& options) {
    const auto samples = parse<int>(text);
    if (!samples || (*samples != 1 && *samples != 2 && *samples != 4 && *samples != 8))
        refuse("--samples", text, "1, 2, 4 or 8");
    options.quality.samples = *samples;
}

void read_resolve(const std::string& text, Options& options) {
    if (text != "pixel" && text != "sample") refuse("--resolve", text, "pixel or sample");
    options.quality.resolve = text == "pixel" ? Resolve::per_pixel : Resolve::per_sample;
}

void read_format(const std::string& text, Options& options) {
    std::string names;
    for (const NodeFormatName& entry : node_formats) {
        names += (names.empty() ? "" : ", ") + std::string(entry.name);
        if (entry.name != text) continue;
        options.quality.format = entry.format;
        return;
    }
    refuse("--format", text, "one of " + names);
}

void read_depth_scale(const std::string& text, Options& options) {
    if (text != "linear" && text != "reversed") refuse("--depth-scale", text, "linear or reversed");
    options.quality.depth_scale = text == "linear" ? DepthScale::linear : DepthScale::reversed;
}

void read_reduce(const std::string& text, Options& options) {
    const auto reduce = parse<int>(text);
    if (!reduce || (*reduce != 1 && *reduce != 2 && *reduce != 4))
        refuse("--reduce", text, "1, 2 or 4");
    options.quality.reduce = *reduce;
}

// A number of bytes, or of a unit of them.
void read_memory(const std::string& text, Options& options) {
    if (text.empty()) return;
    constexpr std::pair<std::string_view, int> units[] = {
        {"KiB", 10}, {"MiB", 20}, {"GiB", 30}, {"", 0}};
    for (const auto& [name, shift] : units) {
        if (!std::string_view(text).ends_with(name)) continue;
        const auto number =
            parse<std::uint64_t>(std::string_view(text).substr(0, text.size() - name.size()));
        if (!number || *number == 0 || *number > ~std::uint64_t{0} >> shift) break;
        options.memory_bytes = *number << shift;
        return;
    }
    refuse("--memory", text, "a whole number of bytes, KiB, MiB or GiB, such as 64MiB");
}

// A kind of blending, or a file with a function.
void read_blend(const std::string& text, Options& options) {
    constexpr std::pair<std::string_view, Blend> kinds[] = {
        {"over", Blend::over},
        {"additive", Blend::additive},
        {"multiplicative", Blend::multiplicative},
        {"absorb", Blend::absorb},
    };
    if (text.empty()) return;
    for (const auto& [name, blend] : kinds)
        if (text == name) {
            options.blend = blend;
            return;
        }
    std::ifstream file(text, std::ios::binary);
    std::error_code error;
    if (!file || std::filesystem::is_directory(text, error))
        refuse("--blend", text,
               "over, additive, multiplicative, absorb, or a file with an OpenCL C function");
    options.blend = Blend::user;
    options.blend_function = {{std::istreambuf_iterator<char>(file), {}}, text};
}

std::string names_of_tables() {
    std::string text = "Methods:\n";
    const auto line = [&](std::string_view name, std::string_view summary) {
        text += "  " + std::string(name) +
                std::string(name.size() < 24 ? 24 - name.size() : 1, ' ') + std::string(summary) +
                "\n";
    };
    for (const MethodInfo& info : methods()) line(info.name, info.summary);
    text += "Scenes:\n";
    for (const SceneInfo& info : scenes()) line(info.name, info.summary);
    return text;
}

}  // namespace

Options parse_options(int count, const char* const* arguments) {
    Options options;
    std::string size = "1280x720", alpha = "0.35", layers = "all", view = "25,8", samples = "1",
                resolve = "pixel", format = "float", depth_scale = "linear", epsilon = "0", eyes,
                time = "0", blend, reduce = "1", memory, out = options.out.string(), json,
                frames = "5";
    CLI::App app{"Draws a mesh or a scene with order-independent transparency.", "cellist-oit"};
    const auto add = [&](const char* name, std::string& value, const char* what, const char* type) {
        CLI::Option* option = app.add_option(name, value, what)->type_name(type);
        if (!value.empty()) option->capture_default_str();
    };
    add("scene", options.scene, "mesh that Assimp reads (OBJ, PLY, STL, glTF, ...), or a scene",
        "MESH|SCENE");
    add("--method", options.method, "how the fragments become an image", "M");
    add("--size", size, "image size in pixels", "WxH");
    add("--alpha", alpha, "opacity of the surfaces, 0 to 1", "A");
    add("--blend", blend,
        "how surfaces blend: over, additive, multiplicative, absorb, or a file with a function",
        "KIND|FILE");
    add("--layers", layers, "nearest layers to blend", "K|all");
    add("--epsilon", epsilon, "stop blending where no more than this part of the light passes",
        "E");
    add("--samples", samples, "samples of a pixel: 1, 2, 4 or 8", "N");
    add("--resolve", resolve, "where samples are blended: pixel or sample", "WHERE");
    app.add_flag("--depth-range", options.quality.depth_range,
                 "blend surfaces that meet within a pixel by their least and greatest depths");
    add("--format", format, "colour and depth of fragments", "F");
    add("--depth-scale", depth_scale, "what 16 and 24 bits of depth divide: linear or reversed",
        "S");
    add("--reduce", reduce,
        "draw transparent surfaces with 2 or 4 times fewer pixels a side, and enlarge them", "N");
    add("--memory", memory,
        "what the method may take on the device, such as 64MiB; lists are drawn in slices",
        "BYTES");
    add("--view", view, "direction to look from, in degrees", "AZIMUTH,ELEVATION");
    add("--stereo", eyes, "two eyes, this far apart; the scene has radius 1", "DISTANCE");
    add("--time", time, "of an animated scene, in seconds", "T");
    app.add_flag("--opaque-floor", options.opaque_floor, "stand the scene on an opaque floor");
    app.add_flag("--reference", options.reference,
                 "compare with a rendering in double precision on the CPU");
    add("--out", out, "picture to write", "FILE.png");
    add("--json", json, "write the figures to this file", "FILE");
    add("--device", options.device,
        "index or part of the name of the device; else CELLIST_DEVICE, a GPU, or the first", "D");
    add("--frames", frames, "timed frames, after one that is not; times are medians", "N");
    app.footer(names_of_tables());
    if (const auto help = support::parse_command_line(app, count, arguments)) {
        options.help = true;
        options.help_text = *help;
        return options;
    }
    if (options.scene.empty()) throw InputError("no mesh or scene given (see --help)");
    options.out = out;
    options.json = json;
    read_size(size, options);
    const auto alpha_value = read_between("--alpha", alpha, 0, 1, "a number from 0 to 1");
    options.alpha = static_cast<float>(alpha_value);
    read_blend(blend, options);
    read_layers(layers, options);
    options.quality.epsilon =
        static_cast<float>(read_between("--epsilon", epsilon, 0, 1, "a number from 0 to 1"));
    read_samples(samples, options);
    read_resolve(resolve, options);
    read_format(format, options);
    read_depth_scale(depth_scale, options);
    read_reduce(reduce, options);
    read_memory(memory, options);
    read_view(view, options);
    if (!eyes.empty())
        options.eye_separation = read_between("--stereo", eyes, 0, 1, "a distance from 0 to 1");
    options.time = read_between("--time", time, -1e6, 1e6, "seconds from -1000000 to 1000000");
    options.frames =
        static_cast<std::uint32_t>(support::read_number("--frames", frames, 1, 1'000'000));
    if (options.quality.depth_range && options.quality.samples == 1)
        throw InputError("--depth-range needs several samples: add --samples 2, 4 or 8");
    if (options.quality.reduce > 1 && options.quality.samples > 1)
        throw InputError("--reduce draws one sample a pixel: leave out --samples");
    (void)method_named(options.method);
    return options;
}

}  // namespace oit
