// SPDX-License-Identifier: MIT
// A heat map shows each value at its place, and its scale tells which value a colour is.
#include "heat_map.hpp"

#include <cmath>
#include <cstring>
#include <numeric>

#include "oit/support/program.hpp"
#include "options.hpp"
#include "reference/reference.hpp"
#include "report/picture.hpp"

namespace cellist::test {
namespace {

using Colour = std::array<std::uint8_t, 3>;

constexpr Colour ink{255, 255, 255};

Colour colour_at(const support::HeatPicture& picture, int x, int y) {
    const auto at = static_cast<std::size_t>(3 * (y * picture.width + x));
    return {picture.bytes[at], picture.bytes[at + 1], picture.bytes[at + 2]};
}

// The L* of CIE 1976.
double lightness(const Colour& colour) {
    constexpr double weights[] = {0.2126, 0.7152, 0.0722};
    double luminance = 0;
    for (std::size_t c = 0; c < 3; ++c) {
        const double encoded = colour[c] / 255.0;
        luminance += weights[c] * (encoded <= 0.04045 ? encoded / 12.92
                                                      : std::pow((encoded + 0.055) / 1.055, 2.4));
    }
    return luminance > 0.008856 ? 116 * std::cbrt(luminance) - 16 : 903.3 * luminance;
}

TEST_CASE("lightness rises with the value, about evenly") {
    constexpr int steps = 64;
    CHECK(lightness(support::heat_colour(0)) < 1);
    CHECK(lightness(support::heat_colour(1)) > 97);
    for (int i = 0; i < steps; ++i) {
        const double step = lightness(support::heat_colour((i + 1.0) / steps)) -
                            lightness(support::heat_colour(1.0 * i / steps));
        INFO(i);
        CHECK(step > 0.4 * 100 / steps);
        CHECK(step < 2.0 * 100 / steps);
    }
    CHECK(support::heat_colour(-1) == support::heat_colour(0));
    CHECK(support::heat_colour(2) == support::heat_colour(1));
}

TEST_CASE("the scale hides no value, and the greatest value has the brightest colour") {
    for (const auto& [width, height] : {std::pair{1, 1}, {3, 200}, {64, 48}, {500, 4}}) {
        INFO(width << "x" << height);
        std::vector<double> values(static_cast<std::size_t>(width * height));
        std::iota(values.begin(), values.end(), 1.0);
        const support::HeatPicture picture = support::heat_picture(
            {.values = values, .width = width, .height = height, .caption = "layers"});
        CHECK(picture.width >= width);
        CHECK(picture.height > height);
        CHECK(picture.bytes.size() == static_cast<std::size_t>(3 * picture.width * picture.height));
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x)
                CHECK(colour_at(picture, x, y) ==
                      support::heat_colour((y * width + x + 1.0) / (width * height)));
        CHECK(colour_at(picture, width - 1, height - 1) == support::heat_colour(1));
    }
}

// Where the ticks of a map up to `most` are, as parts of the scale: the row below the bar, which
// ends with the brightest colour.
std::vector<double> ticks_of(double most, bool are_counts, int width = 400) {
    const std::vector<double> values(static_cast<std::size_t>(width), most);
    const support::HeatPicture picture = support::heat_picture(
        {.values = values, .width = width, .height = 1, .caption = "", .are_counts = are_counts});
    int row = 0, right = 0;
    for (int y = 1; y < picture.height; ++y)
        for (int x = 0; x < picture.width; ++x)
            if (colour_at(picture, x, y) == support::heat_colour(1)) {
                row = y + 1;
                right = x;
            }
    std::vector<double> starts;
    for (int x = 1; x < picture.width; ++x)
        if (colour_at(picture, x, row) == ink && colour_at(picture, x - 1, row) != ink)
            starts.push_back(x);
    REQUIRE_FALSE(starts.empty());
    const double left = starts.front(), length = right - 1 - left;  // a tick is two pixels wide
    for (double& start : starts) start = (start - left) / length;
    return starts;
}

TEST_CASE("ticks of counts are whole numbers at their own place") {
    const auto check_ticks = [](const std::vector<double>& ticks,
                                const std::vector<double>& parts) {
        REQUIRE(ticks.size() == parts.size());
        for (std::size_t i = 0; i < ticks.size(); ++i)
            CHECK(ticks[i] == Approx(parts[i]).margin(0.005));
    };
    check_ticks(ticks_of(0, true), {0});
    check_ticks(ticks_of(1, true), {0, 1});
    check_ticks(ticks_of(2, true), {0, 0.5, 1});
    check_ticks(ticks_of(3, true), {0, 1.0 / 3, 1});
    check_ticks(ticks_of(41, true), {0, 20.0 / 41, 1});
    check_ticks(ticks_of(1, false), {0, 0.5, 1});
    check_ticks(ticks_of(3e-7, false), {0, 0.5, 1});
}

// The grey values of a PFM file, row by row from the top.
struct Floats {
    int width = 0, height = 0;
    std::vector<float> values;
};

Floats floats_of(const std::string& file) {
    Floats floats;
    int begin = 0;
    REQUIRE(std::sscanf(file.c_str(), "PF\n%d %d\n-1.0\n%n", &floats.width, &floats.height,
                        &begin) == 2);
    const auto row = static_cast<std::size_t>(floats.width),
               rows = static_cast<std::size_t>(floats.height);
    REQUIRE(file.size() == static_cast<std::size_t>(begin) + 12 * row * rows);
    for (std::size_t y = rows; y-- > 0;)
        for (std::size_t x = 0; x < row; ++x) {
            float channels[3];
            std::memcpy(channels, &file[static_cast<std::size_t>(begin) + 12 * (y * row + x)], 12);
            CHECK(channels[0] == channels[1]);
            CHECK(channels[0] == channels[2]);
            floats.values.push_back(channels[0]);
        }
    return floats;
}

// The layers that the reference has for these arguments, all eyes side by side.
Floats expected_layers(const Program& program, const std::string& view) {
    const std::string mesh = (program.folder() / "knot.obj").string();
    std::istringstream words(view);
    std::vector<std::string> arguments{"program", mesh};
    for (std::string word; words >> word;) arguments.push_back(word);
    std::vector<const char*> pointers;
    for (const std::string& argument : arguments) pointers.push_back(argument.c_str());
    const oit::Options options =
        oit::parse_options(static_cast<int>(pointers.size()), pointers.data());
    oit::Scene scene = oit::make_scene(options);
    oit::stand_on_floor(scene, options);
    const oit::Frame frame = oit::make_frame(scene, options);
    const std::vector<cl_uint> layers =
        oit::side_by_side(oit::draw_reference(frame).layers(), frame);
    CHECK(std::ranges::max(layers) > 3);
    return {oit::picture_width(frame), frame.height(), {layers.begin(), layers.end()}};
}

void require_layers(const Program& program, const std::string& view, const std::string& more,
                    const std::string& file = "h.pfm") {
    const ProgramResult result =
        program.run("knot.obj " + view + " --heatmap " + file + " " + more);
    INFO(view << ' ' << more << ": " << result.error);
    REQUIRE(result.exit_code == 0);
    const Floats floats = floats_of(file == "-" ? result.out : read_file(program.folder() / file));
    const Floats expected = expected_layers(program, view);
    CHECK(floats.width == expected.width);
    CHECK(floats.height == expected.height);
    CHECK(floats.values == expected.values);
}

TEST_CASE("floats are the layers of each pixel, as the reference counts them") {
    const Program oit(CELLIST_OIT_PROGRAM), tradeoff(CELLIST_TRADEOFF_PROGRAM);
    for (const std::string view : {"--size 60x45 --view 30,10 --opaque-floor",
                                   "--size 40x30 --view 30,10 --stereo 0.2 --samples 2"}) {
        for (const std::string method : {"linked", "weighted", "linked --memory 200KiB"})
            require_layers(oit, view, "--frames 1 --method " + method);
        require_layers(oit, view, "--frames 1 --budget 20dB --search-seconds 1");
        require_layers(tradeoff, view, "--frames 1 --methods weighted");
    }
    // Of the last frame.
    require_layers(oit, "--size 60x45 --view 120,10", "--frames 2");
    const ProgramResult turned =
        oit.run("knot.obj --size 60x45 --view 30,10 --turn 90 --frames 2 --heatmap turned.pfm");
    REQUIRE(turned.exit_code == 0);
    CHECK(read_file(oit.folder() / "turned.pfm") == read_file(oit.folder() / "h.pfm"));
}

TEST_CASE("both programs draw the same heat map, with a scale") {
    const Program oit(CELLIST_OIT_PROGRAM), tradeoff(CELLIST_TRADEOFF_PROGRAM);
    const std::string view = "knot.obj --size 64x48 --frames 1 --heatmap ";
    const ProgramResult file = oit.run(view + "h.png");
    REQUIRE(file.exit_code == 0);
    CHECK(contains(file.out, "heat map          h.png\n"));
    const std::string picture = read_file(oit.folder() / "h.png");
    CHECK(picture.starts_with("\x89PNG"));
    const ProgramResult screen = oit.run(view + "-");
    REQUIRE(screen.exit_code == 0);
    CHECK(screen.out == picture);
    CHECK(contains(screen.error, "heat map          on stdout\n"));
    REQUIRE(tradeoff.run(view + "h.png --methods weighted").exit_code == 0);
    CHECK(read_file(tradeoff.folder() / "h.png") == picture);
    CHECK(tradeoff.run(view + "- --methods weighted").out == picture);
}

TEST_CASE("both programs draw the same heat map of exact coverage") {
    const Program oit(CELLIST_OIT_PROGRAM), tradeoff(CELLIST_TRADEOFF_PROGRAM);
    const std::string view = "knot.obj --size 24x18 --frames 1 --heatmap h.pfm --samples ";
    REQUIRE(oit.run(view + "exact").exit_code == 0);
    REQUIRE(tradeoff.run(view + "all").exit_code == 0);
    CHECK(read_file(tradeoff.folder() / "h.pfm") == read_file(oit.folder() / "h.pfm"));
}

TEST_CASE("a scene with no layers has a black heat map") {
    const Program program(CELLIST_OIT_PROGRAM);
    const ProgramResult result =
        program.run("extreme-nothing --size 3x2 --frames 1 --heatmap h.png");
    INFO(result.error);
    CHECK(result.exit_code == 0);
    CHECK(read_file(program.folder() / "h.png").starts_with("\x89PNG"));
}

TEST_CASE("a heat map that cannot be written is refused before anything is drawn") {
    for (const char* path : {CELLIST_OIT_PROGRAM, CELLIST_TRADEOFF_PROGRAM}) {
        const Program program(path);
        for (const auto& [arguments, named] : {std::pair{"--heatmap h.txt", ".exr"},
                                               {"--heatmap h", ".png"},
                                               {"--heatmap missing/h.png", "missing"},
                                               {"--heatmap .", "folder"},
                                               {"--heatmap h.png --json ./h.png", "same file"},
                                               {"--heatmap knot.obj", "the mesh"}})
            program.require_refused(std::string("knot.obj ") + arguments, named);
    }
}

}  // namespace
}  // namespace cellist::test
