#include "tradeoff/tradeoff_options.hpp"

#include <algorithm>
#include <array>
#include <sstream>

#include <CLI/CLI.hpp>

#include "command_line.hpp"
#include "files.hpp"
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
    return std::ranges::any_of(std::array{json, csv, html}, support::is_standard_output);
}

TradeoffOptions parse_tradeoff_options(int count, const char* const* arguments) {
    TradeoffOptions options;
    options.width = 640;
    options.height = 360;
    std::string methods = "all", frames = std::to_string(options.frames), json, csv, html;
    CLI::App app{
        "Draws a scene with every method and setting. Measures the cost of each, and its error "
        "against a rendering in double precision.",
        "cellist-tradeoff"};
    const auto add = [&](const char* name, std::string& value, const char* what, const char* type) {
        add_option(app, name, value, what, type);
    };
    const FrameArguments frame(app, options);
    add("--methods", methods, "methods to compare: all, exact, or names", "M,M,...");
    add("--frames", frames,
        "timed frames of each setting, in three rounds over all of them; times are medians", "N");
    add("--json", json, "write the metrics to this file", "FILE");
    add("--csv", csv, "write a table with a line for each setting to this file", "FILE");
    add("--html", html, "write a report with plot and pictures to this file", "FILE");
    app.footer(help_on_tables());
    if (const auto help = support::parse_command_line(app, count, arguments)) {
        options.help = true;
        options.help_text = *help;
        return options;
    }
    frame.read(options);
    options.methods = read_methods(methods);
    options.frames =
        static_cast<std::uint32_t>(support::read_number("--frames", frames, 1, 1'000'000));
    options.arguments.assign(arguments + 1, arguments + count);
    options.json = json;
    options.csv = csv;
    options.html = html;
    const NamedFile outputs[] = {
        {"--json", options.json}, {"--csv", options.csv}, {"--html", options.html}};
    check_outputs(options, outputs);
    return options;
}

}  // namespace oit
