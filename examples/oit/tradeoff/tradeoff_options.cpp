// SPDX-License-Identifier: MIT
#include "tradeoff/tradeoff_options.hpp"

#include <algorithm>
#include <array>
#include <sstream>

#include "command_line.hpp"
#include "files.hpp"
#include "image.hpp"
#include "input_error.hpp"

namespace oit {
namespace {

// All methods, the exact ones, or those that are named.
std::vector<std::string_view> read_methods(const std::string& text) {
    std::vector<std::string_view> names;
    std::vector<std::string_view> asked;
    std::istringstream list(text);
    for (std::string name; std::getline(list, name, ',');)
        if (name != "all" && name != "exact") asked.push_back(method_named(name).name);
    for (const MethodInfo& info : methods())
        if (text == "all" || (text == "exact" && info.exact) ||
            std::ranges::find(asked, info.name) != asked.end())
            names.push_back(info.name);
    if (names.empty()) support::refuse("--methods", text, "names, separated by commas");
    return names;
}

}  // namespace

bool TradeoffOptions::writes_to_stdout() const {
    return std::ranges::any_of(std::array{heatmap, json, csv, html}, support::is_standard_output);
}

TradeoffOptions parse_tradeoff_options(int count, const char* const* arguments) {
    TradeoffOptions options;
    options.width = 640;
    options.height = 360;
    support::CommandLine line(
        "cellist-tradeoff",
        "Draws a scene with every method and setting. Measures the cost of "
        "each, and its error against a rendering in double precision. With --samples "
        "all, compares 1, 2, 4 and 8 samples and exact coverage with 4,096 "
        "samples.");
    add_frame_options(line, options);
    line.add("--methods", "all", "methods to compare: all, exact, or names", "M,M,...",
             [&](const std::string& text) { options.methods = read_methods(text); });
    line.add_number("--frames", options.frames, 1, 1'000'000,
                    "timed frames of each setting, in three rounds over all of them; times are "
                    "medians");
    line.add_text("--heatmap", options.heatmap,
                  "write the number of layers in each pixel: as colours with a scale in .png and "
                  ".jpg, unscaled in .pfm and .exr",
                  "FILE");
    line.add_text("--json", options.json, "write the metrics to this file", "FILE");
    line.add_text("--csv", options.csv, "write a table with a line for each setting to this file",
                  "FILE");
    line.add_text("--html", options.html, "write a report with plot and pictures to this file",
                  "FILE");
    line.add_check([&] {
        const support::IdleOption idle[] = {
            {"--methods", options.all_samples,
             "--samples all draws with the method linked: leave out --methods"}};
        line.refuse_idle(idle);
        if (options.all_samples) options.methods = {"linked"};
        const support::NamedFile outputs[] = {{"--heatmap", options.heatmap},
                                              {"--json", options.json},
                                              {"--csv", options.csv},
                                              {"--html", options.html}};
        check_outputs(options, outputs);
        if (!options.heatmap.empty()) (void)support::image_format(options.heatmap);
    });
    line.add_footer(help_on_tables());
    options.help_text = line.parse(count, arguments).value_or("");
    options.arguments.assign(arguments + 1, arguments + count);
    return options;
}

}  // namespace oit
