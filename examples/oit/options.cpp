#include "options.hpp"

#include <charconv>
#include <cmath>
#include <string_view>

#include <CLI/CLI.hpp>

#include "input_error.hpp"

namespace oit {
namespace {

using support::InputError;

// The whole text as a number, or nothing.
template <class T>
std::optional<T> parse(std::string_view text) {
    T value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) return {};
    return value;
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

void read_alpha(const std::string& text, Options& options) {
    const auto alpha = parse<double>(text);
    if (!alpha || !(*alpha >= 0 && *alpha <= 1))
        throw InputError("--alpha " + text + ": expected a number from 0 to 1");
    options.alpha = static_cast<float>(*alpha);
}

void read_layers(const std::string& text, Options& options) {
    if (text == "all") return;
    const auto layers = parse<long long>(text);
    if (!layers || *layers < 1 || *layers > 0xFFFFFFFF)
        throw InputError("--layers " + text + ": expected 'all' or a number from 1 to 4294967295");
    options.layers = static_cast<std::uint32_t>(*layers);
}

void read_view(const std::string& text, Options& options) {
    const std::size_t comma = text.find(',');
    const auto azimuth = parse<double>(std::string_view(text).substr(0, comma));
    const auto elevation = comma == std::string::npos
                               ? std::nullopt
                               : parse<double>(std::string_view(text).substr(comma + 1));
    if (!azimuth || !elevation || !std::isfinite(*azimuth) || !std::isfinite(*elevation))
        throw InputError("--view " + text +
                         ": expected AZIMUTH,ELEVATION in degrees, such as 25,8");
    if (std::abs(*elevation) > 90)
        throw InputError("--view " + text + ": the elevation lies between -90 and 90");
    options.orbit = {.azimuth_degrees = std::fmod(*azimuth, 360.0),
                     .elevation_degrees = *elevation};
}

void read_frames(const std::string& text, Options& options) {
    const auto frames = parse<long long>(text);
    if (!frames || *frames < 1 || *frames > 1'000'000)
        throw InputError("--frames " + text + ": expected a number from 1 to 1000000");
    options.frames = static_cast<std::uint32_t>(*frames);
}

}  // namespace

Options parse_options(int count, const char* const* arguments) {
    Options options;
    std::string mesh, size = "1280x720", alpha = "0.35", layers = "all", view = "25,8";
    std::string out = options.out.string(), json, frames = "5";
    CLI::App app{"Draws a mesh with order-independent transparency, through per-pixel lists.",
                 "cellist-oit"};
    app.add_option("mesh", mesh, "mesh that Assimp reads: OBJ, PLY, STL, glTF, ...")
        ->type_name("MESH");
    app.add_option("--size", size, "image size in pixels")->type_name("WxH")->capture_default_str();
    app.add_option("--alpha", alpha, "opacity of the surfaces, 0 to 1")
        ->type_name("A")
        ->capture_default_str();
    app.add_option("--layers", layers, "nearest layers to blend")
        ->type_name("K|all")
        ->capture_default_str();
    app.add_option("--view", view, "direction to look from, in degrees")
        ->type_name("AZIMUTH,ELEVATION")
        ->capture_default_str();
    app.add_flag("--opaque-floor", options.opaque_floor, "stand the mesh on an opaque floor");
    app.add_flag("--reference", options.reference,
                 "compare with a rendering in double precision on the CPU");
    app.add_option("--out", out, "picture to write")->type_name("FILE.png")->capture_default_str();
    app.add_option("--json", json, "write the figures to this file")->type_name("FILE");
    app.add_option(
           "--device", options.device,
           "index or part of the name of the device; else CELLIST_DEVICE, a GPU, or the first")
        ->type_name("D");
    app.add_option("--frames", frames, "timed frames, after one that is not; times are medians")
        ->type_name("N")
        ->capture_default_str();
    try {
        app.parse(count, arguments);
    } catch (const CLI::CallForHelp&) {
        options.help = true;
        options.help_text = app.help();
        return options;
    } catch (const CLI::ParseError& error) {
        const std::string text = error.what();
        throw InputError(text.substr(0, text.find('\n')) + " (see --help)");
    }
    if (mesh.empty()) throw InputError("no mesh given (see --help)");
    options.mesh = mesh;
    options.out = out;
    options.json = json;
    read_size(size, options);
    read_alpha(alpha, options);
    read_layers(layers, options);
    read_view(view, options);
    read_frames(frames, options);
    return options;
}

}  // namespace oit
