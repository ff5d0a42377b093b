#include "grid_options.hpp"

#include <CLI/CLI.hpp>

#include "command_line.hpp"
#include "files.hpp"
#include "frame_options.hpp"
#include "input_error.hpp"
#include "report/number_text.hpp"

namespace oit {
namespace {

int read_side(const std::string& text) {
    return static_cast<int>(support::read_number("--size", text, 1, 16384));
}

}  // namespace

GridOptions parse_grid_options(int count, const char* const* arguments) {
    GridOptions options;
    std::string size = std::to_string(options.width) + "x" + std::to_string(options.height),
                frames = std::to_string(options.frames), cost = shortest(options.cost), meshes,
                json;
    CLI::App app{
        "Checks the choices of cellist-oit --budget, with three budgets for each of ten scenes and "
        "views, or of the given meshes. Draws all settings, compares them with a rendering in "
        "double precision, and finds the cheapest setting within each budget.\n"
        "A case passes if the chosen setting is within the budget and costs at most 1.1 times as "
        "much as the cheapest. It also passes if no setting is within the budget and --budget says "
        "so. The exit code is 0 if all cases pass, and 1 otherwise.\n"
        "PoCL on 2 cores takes less than 10 minutes, and twice as long the first time, because it "
        "builds the kernels.",
        "cellist-budget-grid"};
    const auto add = [&](const char* name, std::string& value, const char* what, const char* type) {
        add_option(app, name, value, what, type);
    };
    std::vector<std::string> files;
    app.add_option("mesh", files, "meshes to draw instead of the ten scenes and views")
        ->type_name("MESH...");
    add("--meshes", meshes,
        "folder with teapot.obj and dragon.ply; their cases are left out without it", "DIR");
    add("--size", size, "image size in pixels", "WxH");
    add("--filter", options.filter, "run only the views whose names contain this text", "TEXT");
    add("--frames", frames,
        "least number of timed frames of each setting; close settings draw more", "N");
    add("--cost", cost, "greatest cost of the chosen setting, relative to the best", "RATIO");
    add("--json", json, "write the metrics to this file", "FILE");
    add("--git", options.git, "the commit to record in the results", "HASH");
    add("--device", options.device,
        "device, by index or part of its name; the default is CELLIST_DEVICE, a GPU, or the first",
        "D");
    if (const auto help = support::parse_command_line(app, count, arguments)) {
        options.help = true;
        options.help_text = *help;
        return options;
    }
    const support::IdleOption idle[] = {
        {"--meshes", !files.empty(), "--meshes is for the ten scenes and views: leave it out"}};
    support::refuse_idle_options(app, idle);
    const std::size_t x = size.find('x');
    if (x == std::string::npos)
        support::refuse("--size", size, "WIDTHxHEIGHT in pixels, such as 320x180");
    options.width = read_side(size.substr(0, x));
    options.height = read_side(size.substr(x + 1));
    for (const std::string& file : files) {
        std::error_code error;
        if (!std::filesystem::is_regular_file(file, error))
            throw support::InputError("'" + support::text_of(file) + "' is not a regular file");
        options.files.emplace_back(file);
    }
    options.meshes = meshes;
    options.frames =
        static_cast<std::uint32_t>(support::read_number("--frames", frames, 1, 10'000));
    options.cost = read_between("--cost", cost, 1, 1e6, "a number from 1 to 1000000");
    if (!json.empty()) support::check_output_path(json);
    options.json = json;
    return options;
}

}  // namespace oit
