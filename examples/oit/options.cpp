// SPDX-License-Identifier: MIT
#include "options.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <string_view>
#include <utility>

#include "budget/setting.hpp"
#include "command_line.hpp"
#include "files.hpp"
#include "image.hpp"
#include "input_error.hpp"
#include "number_text.hpp"

namespace oit {
namespace {

using support::refuse;

void read_method(const std::string& text, Options& options) {
    options.method = text.substr(0, text.find(':'));
    const MethodInfo& info = method_named(options.method);
    if (options.method != text)
        options.quality.size = read_size_of(info, text.substr(options.method.size() + 1));
}

void read_layers(const std::string& text, Options& options) {
    if (text == "all") return;
    std::uint32_t layers = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), layers);
    if (error != std::errc() || end != text.data() + text.size() || layers == 0)
        refuse("--layers", text, "'all' or a number from 1 to 4294967295");
    options.quality.layers = layers;
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

void read_reduce(const std::string& text, Options& options) {
    if (text != "1" && text != "2" && text != "4") refuse("--reduce", text, "1, 2 or 4");
    options.quality.reduce = text.front() - '0';
}

void check_outputs(const Options& options) {
    const std::filesystem::path first = options.out.of(1);
    const support::NamedFile outputs[] = {{"--out", first},
                                          {"--write-reference", options.write_reference},
                                          {"--write-difference", options.write_difference},
                                          {"--heatmap", options.heatmap},
                                          {"--json", options.json}};
    check_outputs(options, outputs);
    for (const std::filesystem::path& picture :
         {first, options.write_reference, options.write_difference, options.heatmap})
        if (!picture.empty()) (void)support::image_format(picture);
}

// Options that have no effect with the other options, or contradict them.
void refuse_idle_options(const support::CommandLine& line, const Options& options) {
    const bool has_budget = options.budget.has_value(), one_frame = options.frames == 1;
    const MethodInfo& method = method_named(options.method);
    const bool is_exact = options.quality.coverage == Coverage::exact;
    const auto idle_if = [](bool idle, const std::string& before, const char* name,
                            const char* after) {
        std::string reason = before;
        reason += name;
        reason += after;
        return support::IdleOption{name, idle, std::move(reason)};
    };
    const auto chosen = [&](const char* name) {
        return idle_if(has_budget, "--budget chooses what ", name, " sets: leave one of them out");
    };
    const auto not_compared = [&](const char* name) {
        return idle_if(has_budget, "--budget compares settings without ", name,
                       ": leave one of them out");
    };
    const auto of_budget = [&](const char* name) {
        return idle_if(!has_budget, "", name, " is for --budget, which is not given");
    };
    const auto of_nodes = [&](const char* name) {
        return idle_if(!method.has_nodes,
                       "--method " + options.method + " keeps no fragments: leave out ", name, "");
    };
    const auto of_frames = [&](const char* name) {
        return idle_if(one_frame, "", name, " needs several frames: --frames is 1");
    };
    const auto not_distributed = [&](const char* name) {
        return idle_if(options.mpi, "--mpi draws without ", name, ": leave one of them out");
    };
    const support::IdleOption table[] = {
        chosen("--method"),
        chosen("--layers"),
        chosen("--epsilon"),
        chosen("--format"),
        not_compared("--reduce"),
        not_compared("--memory"),
        {"--blend", has_budget && options.blend_function,
         "--budget has no error bound for a function of your own: leave one of them out"},
        {"--reduce", options.quality.reduce > 1 && (options.quality.samples > 1 || is_exact),
         "--reduce draws one sample per pixel: leave out --samples"},
        {"--reduce", options.quality.reduce > 1 && options.lens.has_value(),
         "--reduce has no layers for --lens: leave one of them out"},
        {"--memory", options.lens.has_value(),
         "--memory draws slices, and --lens needs all layers at once: leave one of them out"},
        {"--samples", options.all_samples,
         "--samples all is for cellist-tradeoff: choose 1, 2, 4, 8 or exact"},
        {"--layers", is_exact && options.quality.layers.has_value(),
         "--samples exact blends all triangles of a pixel: leave out --layers"},
        {"--lens-rays", !options.lens, "--lens-rays is for --lens, which is not given"},
        {"--lens-rays", method.draws_views,
         "--method " + options.method + " sends no rays: leave out --lens-rays"},
        {"--budget", options.lens.has_value(),
         "--budget has no error bound for --lens: leave one of them out"},
        {"--budget", is_exact,
         "--budget has no error bound for --samples exact: leave one of them out"},
        of_budget("--check-every"),
        of_budget("--search-seconds"),
        of_budget("--strict"),
        of_nodes("--epsilon"),
        of_nodes("--format"),
        of_frames("--until"),
        of_frames("--turn"),
        not_distributed("--lens"),
        not_distributed("--reduce"),
        not_distributed("--memory"),
        not_distributed("--budget"),
        not_distributed("--heatmap"),
        {"--samples", options.mpi && is_exact,
         "--mpi does not send the triangles that --samples exact needs: leave one of them out"},
        {"--check-every", !options.moves(),
         "--check-every is for frames that change: add --until or --turn"},
    };
    line.refuse_idle(table);
}

void add_quality_options(support::CommandLine& line, Options& options) {
    using Text = const std::string&;
    line.add("--method", options.method, "transparency method, from the list below", "M[:SIZE]",
             [&](Text text) { read_method(text, options); });
    line.add("--layers", "all", "nearest layers to blend", "K|all",
             [&](Text text) { read_layers(text, options); });
    line.add("--epsilon", support::shortest(options.quality.epsilon),
             "stop blending once the transmittance is at most E", "E", [&](Text text) {
                 options.quality.epsilon = static_cast<float>(
                     support::read_between("--epsilon", text, 0, 1, "a number from 0 to 1"));
             });
    line.add("--format", std::string(name_of(options.quality.format)),
             "format of colour and depth in a fragment", "F",
             [&](Text text) { read_format(text, options); });
    line.add("--reduce", std::to_string(options.quality.reduce),
             "draw transparent surfaces with 1/N of the width and height, and enlarge them", "N",
             [&](Text text) { read_reduce(text, options); });
    line.add_number("--lens-rays", options.quality.lens_rays, 1, 4096,
                    "rays per pixel through the lens");
    line.add("--memory", "",
             "limit on the device memory of the method, such as 64MiB; lists are drawn in slices",
             "BYTES",
             [&](Text text) { options.memory_bytes = support::read_bytes("--memory", text); });
}

void add_budget_options(support::CommandLine& line, Options& options, bool& strict) {
    using Text = const std::string&;
    line.add("--budget", "",
             "find the cheapest setting with at least this PSNR, or at most this error",
             "40dB|1/255", [&](Text text) { options.budget = parse_budget(text); });
    line.add_number("--check-every", options.check_every, 1, 1'000'000,
                    "check each N-th changed frame against the budget");
    line.add("--search-seconds", support::shortest(options.search_seconds),
             "time limit of the search for a setting within the budget", "S", [&](Text text) {
                 options.search_seconds = support::read_between("--search-seconds", text, 0, 1e6,
                                                                "seconds from 0 to 1000000");
             });
    line.add_flag(
        "--strict", strict,
        "also apply the budget to undecided pixels, where float depths do not resolve the "
        "order of layers");
}

void add_motion_options(support::CommandLine& line, Options& options) {
    using Text = const std::string&;
    line.add("--until", "", "time of the last frame, in seconds; the first is at --time", "T",
             [&](Text text) {
                 options.until = support::read_between("--until", text, -1e6, 1e6,
                                                       "seconds from -1000000 to 1000000");
             });
    line.add("--turn", support::shortest(options.turn_degrees),
             "turn the camera from the first frame to the last", "DEGREES", [&](Text text) {
                 options.turn_degrees = support::read_between("--turn", text, -1e6, 1e6,
                                                              "degrees from -1000000 to 1000000");
             });
}

void add_output_options(support::CommandLine& line, Options& options) {
    using Text = const std::string&;
    line.add_flag("--reference", options.reference,
                  "compare with a rendering in double precision on the CPU; with --lens or "
                  "--samples exact, with the mean of many pictures");
    line.add("--out", options.out.path().string(),
             "picture to write: .png, .jpg, .pfm or .exr, - for stdout; all frames as "
             "frame-%04d.png",
             "FILE", [&](Text text) { options.out = support::PictureName(text); });
    line.add_text("--write-reference", options.write_reference,
                  "write the rendering in double precision to this file", "FILE");
    line.add_text(
        "--write-difference", options.write_difference,
        "write the difference from that rendering: times 16 in .png and .jpg, unscaled in "
        ".pfm and .exr",
        "FILE");
    line.add_text("--heatmap", options.heatmap,
                  "write the number of layers in each pixel of the last frame: as colours with a "
                  "scale in .png and .jpg, unscaled in .pfm and .exr",
                  "FILE");
    line.add_text("--json", options.json, "write the metrics to this file", "FILE");
    line.add_number("--frames", options.frames, 1, 1'000'000,
                    "timed frames, after a warm-up; times are medians");
    line.add_flag("--mpi", options.mpi,
                  "share the triangles and the rows of the picture between the ranks of mpirun");
}

}  // namespace

bool Options::writes_to_stdout() const {
    return std::ranges::any_of(
        std::array{out.of(1), write_reference, write_difference, heatmap, json},
        support::is_standard_output);
}

Options parse_options(int count, const char* const* arguments) {
    Options options;
    bool strict = false;
    support::CommandLine line("cellist-oit",
                              "Draws a mesh or a scene with order-independent transparency.");
    add_frame_options(line, options);
    add_quality_options(line, options);
    add_budget_options(line, options, strict);
    add_motion_options(line, options);
    add_output_options(line, options);
    line.add_check([&] {
        if (options.budget) options.budget->strict = strict;
        check_outputs(options);
        refuse_idle_options(line, options);
    });
    line.add_footer(help_on_tables());
    options.help_text = line.parse(count, arguments).value_or("");
    options.arguments.assign(arguments + 1, arguments + count);
    options.reference =
        options.reference || !options.write_reference.empty() || !options.write_difference.empty();
    return options;
}

}  // namespace oit
