// SPDX-License-Identifier: MIT
// Compares the choice of --budget with all settings, for ten scenes and views.
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <limits>
#include <string>
#include <vector>

#include <cellist/cellist.hpp>

#include "budget/budget_controller.hpp"
#include "cases.hpp"
#include "command_line.hpp"
#include "files.hpp"
#include "grid_options.hpp"
#include "grid_report.hpp"
#include "input_error.hpp"
#include "json_report.hpp"
#include "report/frame_json.hpp"
#include "search.hpp"

namespace {

// Times what was chosen and what is best again, interleaved.
void time_both(oit::ExhaustiveSearch& search, const oit::SettingMeasurement& chosen,
               const oit::SettingMeasurement& best, oit::GridCase& result) {
    const oit::SettingMeasurement* both[] = {&chosen, &best};
    const std::vector<oit::FrameTimes> times = search.time_again(both);
    result.chosen.times = times[0];
    result.best->times = times[1];
    if (&chosen != &best) result.cost = times[0].median_ms / times[1].median_ms;
}

oit::GridCase run_case(const cellist::Device& device, const oit::Frame& frame,
                       oit::ExhaustiveSearch& search, const oit::GridView& view,
                       const std::string& budget_text) {
    oit::GridCase result{.name = view.name + " " + budget_text,
                         .budget = oit::parse_budget(budget_text)};
    // As cellist-oit does.
    const oit::BudgetController controller(device, frame, result.budget);
    result.choice = controller.choice();
    result.chosen = {.setting = result.choice.setting,
                     .errors = search.truth().errors_of(controller.renderer().image())};
    const oit::SettingMeasurement* best = search.best(result.budget);
    if (best) result.best = *best;
    const oit::SettingMeasurement* chosen = search.find(result.choice.setting);
    if (best && chosen)
        time_both(search, *chosen, *best, result);
    else if (best)
        result.cost = std::numeric_limits<double>::infinity();
    return result;
}

oit::GridResult run_view(const cellist::Device& device, const oit::GridView& view,
                         const oit::GridOptions& options) {
    oit::FrameOptions drawn = oit::frame_options(view);
    drawn.width = options.width;
    drawn.height = options.height;
    oit::Scene scene = oit::make_scene(drawn);
    oit::stand_on_floor(scene, drawn);
    const oit::Frame frame = oit::make_frame(scene, drawn);
    oit::ExhaustiveSearch search(device, frame, options.frames);
    oit::GridResult result{.view = &view,
                           .fragments = search.truth().reference().fragments.size(),
                           .most_layers = search.truth().reference().most_layers(),
                           .pixels_ambiguous = search.truth().pixels_ambiguous(),
                           .measurements = search.measurements()};
    for (const std::string& budget : view.budgets) {
        result.cases.push_back(run_case(device, frame, search, view, budget));
        print(result.cases.back(), options.cost, std::cout);
        std::cout.flush();
    }
    return result;
}

std::vector<oit::GridView> views_of(const oit::GridOptions& options) {
    if (options.files.empty()) return oit::grid_views(options.meshes);
    std::vector<oit::GridView> views;
    for (const std::filesystem::path& mesh : options.files)
        views.push_back(oit::view_of_mesh(mesh));
    return views;
}

// Whether all cases pass.
bool run(const oit::GridOptions& options) {
    const cellist::Device device = options.device.empty() ? cellist::Device::choose()
                                                          : cellist::Device::choose(options.device);
    std::cout << "cellist-budget-grid, " << options.width << 'x' << options.height << ", "
              << device.info().name << " (driver " << device.info().driver << ")\n";
    std::vector<oit::GridResult> results;
    std::size_t cases = 0, met = 0;
    const std::vector<oit::GridView> views = views_of(options);
    for (const oit::GridView& view : views) {
        if (view.name.find(options.filter) == std::string::npos) continue;
        if (options.files.empty() && options.meshes.empty() && is_of_mesh(view)) {
            std::cout << "left out without --meshes: " << view.name << ", " << view.budgets.size()
                      << " cases\n";
            continue;
        }
        results.push_back(run_view(device, view, options));
        cases += results.back().cases.size();
        met += static_cast<std::size_t>(std::ranges::count_if(
            results.back().cases,
            [&](const oit::GridCase& grid_case) { return grid_case.met(options.cost); }));
    }
    if (cases == 0) throw support::InputError("--filter " + options.filter + " leaves no case");
    std::cout << met << " of " << cases << " cases met\n";
    if (!options.json.empty())
        support::write_file(options.json,
                            support::dump(to_json(results, options, device), 2) + '\n');
    return met == cases;
}

}  // namespace

int main(int count, char** arguments) {
    return support::run_program("cellist-budget-grid", [&] {
        const oit::GridOptions options = oit::parse_grid_options(count, arguments);
        if (options.help_text.empty()) return run(options);
        std::cout << options.help_text;
        return true;
    });
}
