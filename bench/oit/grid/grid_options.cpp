// SPDX-License-Identifier: MIT
#include "grid_options.hpp"

#include "command_line.hpp"
#include "files.hpp"
#include "input_error.hpp"
#include "number_text.hpp"

namespace oit {
namespace {

void read_size(const std::string& text, GridOptions& options) {
    const std::size_t x = text.find('x');
    if (x == std::string::npos)
        support::refuse("--size", text, "WIDTHxHEIGHT in pixels, such as 320x180");
    const auto side = [](const std::string& number) {
        return static_cast<int>(support::read_number("--size", number, 1, 16384));
    };
    options.width = side(text.substr(0, x));
    options.height = side(text.substr(x + 1));
}

}  // namespace

GridOptions parse_grid_options(int count, const char* const* arguments) {
    GridOptions options;
    support::CommandLine line(
        "cellist-budget-grid",
        "Checks the choices of cellist-oit --budget, with three budgets for each of ten scenes and "
        "views, or of the given meshes. Draws all settings, compares them with a rendering in "
        "double precision, and finds the cheapest setting within each budget.\n"
        "A case passes if the chosen setting is within the budget and costs at most 1.1 times as "
        "much as the cheapest. It also passes if no setting is within the budget and --budget says "
        "so. The exit code is 0 if all cases pass, and 1 otherwise.\n"
        "PoCL on 2 cores takes less than 10 minutes, and twice as long the first time, because it "
        "builds the kernels.");
    line.add_arguments("mesh", "meshes to draw instead of the ten scenes and views", "MESH...",
                       [&](const std::vector<std::string>& files) {
                           for (const std::string& file : files) {
                               std::error_code error;
                               if (!std::filesystem::is_regular_file(file, error))
                                   throw support::InputError("'" + support::text_of(file) +
                                                             "' is not a regular file");
                               options.files.emplace_back(file);
                           }
                       });
    line.add_text("--meshes", options.meshes,
                  "folder with teapot.obj and dragon.ply; their cases are left out without it",
                  "DIR");
    line.add("--size", std::to_string(options.width) + "x" + std::to_string(options.height),
             "image size in pixels", "WxH",
             [&](const std::string& text) { read_size(text, options); });
    line.add_text("--filter", options.filter, "run only the views whose names contain this text",
                  "TEXT");
    line.add_number("--frames", options.frames, 1, 10'000,
                    "least number of timed frames of each setting; close settings draw more");
    line.add("--cost", support::shortest(options.cost),
             "greatest cost of the chosen setting, relative to the best", "RATIO",
             [&](const std::string& text) {
                 options.cost =
                     support::read_between("--cost", text, 1, 1e6, "a number from 1 to 1000000");
             });
    line.add_text("--json", options.json, "write the metrics to this file", "FILE");
    line.add_text("--git", options.git, "the commit to record in the results", "HASH");
    line.add_device(options.device);
    line.add_check([&] {
        const support::IdleOption idle[] = {
            {"--meshes", !options.files.empty(),
             "--meshes is for the ten scenes and views: leave it out"}};
        line.refuse_idle(idle);
        if (!options.json.empty()) support::check_output_path(options.json);
    });
    options.help_text = line.parse(count, arguments).value_or("");
    return options;
}

}  // namespace oit
