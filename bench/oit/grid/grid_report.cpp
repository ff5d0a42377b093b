// SPDX-License-Identifier: MIT
#include "grid_report.hpp"

#include <cmath>
#include <iomanip>
#include <ostream>

#include "number_text.hpp"

namespace oit {
namespace {

using nlohmann::ordered_json;

void print_measurement(const char* what, const SettingMeasurement& measurement,
                       const Budget& budget, std::ostream& out) {
    out << "  " << std::left << std::setw(8) << what << std::setw(50) << text(measurement.setting)
        << std::right << std::setw(12) << budget.text_of(measurement.errors.resolved);
    if (measurement.times.runs > 0)
        out << std::setw(9) << support::fixed(measurement.times.median_ms, 2) << " ms";
}

std::string verdict(const GridCase& grid_case, double most_cost) {
    if (grid_case.met(most_cost)) return "met";
    if (grid_case.kept()) return "NOT MET: too slow";
    return grid_case.choice.met ? "NOT MET: over the budget"
                                : "NOT MET: a setting keeps the budget";
}

ordered_json to_json(const PictureError& error) {
    ordered_json json{{"largest", error.largest}, {"psnr_db", nullptr}};
    if (std::isfinite(error.psnr_db())) json["psnr_db"] = error.psnr_db();
    return json;
}

ordered_json to_json(const SettingMeasurement& measurement) {
    ordered_json json{{"setting", text(measurement.setting)}};
    if (!measurement.failure.empty()) {
        json["failure"] = measurement.failure;
        return json;
    }
    json["error"] = to_json(measurement.errors.resolved);
    json["error_with_any_order"] = to_json(measurement.errors.all);
    json["median_ms"] = measurement.times.median_ms;
    json["least_ms"] = measurement.times.least_ms;
    json["runs"] = measurement.times.runs;
    return json;
}

ordered_json to_json(const GridCase& grid_case, double most_cost) {
    const Choice& choice = grid_case.choice;
    ordered_json json{{"case", grid_case.name},          {"budget", grid_case.budget.text()},
                      {"met", grid_case.met(most_cost)}, {"kept", grid_case.kept()},
                      {"cost", grid_case.cost},          {"says_met", choice.met}};
    json["chosen"] = to_json(grid_case.chosen);
    json["best"] = grid_case.best ? to_json(*grid_case.best) : ordered_json(nullptr);
    json["promised"] = to_json(choice.errors.resolved);
    json["bounded"] = choice.bounded;
    json["draws"] = choice.draws;
    json["took_ms"] = choice.took_ms;
    return json;
}

}  // namespace

bool GridCase::kept() const {
    return choice.met ? budget.met_by(chosen.errors.resolved) : !best.has_value();
}

void print(const GridCase& grid_case, double most_cost, std::ostream& out) {
    out << std::left << std::setw(30) << grid_case.name << verdict(grid_case, most_cost) << '\n';
    print_measurement(grid_case.choice.met ? "chosen" : "closest", grid_case.chosen,
                      grid_case.budget, out);
    out << (grid_case.choice.met ? ", " + support::fixed(grid_case.cost, 2) + " times" : "")
        << '\n';
    if (grid_case.best) {
        print_measurement("best", *grid_case.best, grid_case.budget, out);
        out << '\n';
    }
}

ordered_json to_json(const std::vector<GridResult>& results, const GridOptions& options,
                     const cellist::Device& device) {
    ordered_json json{{"device", device.info().name}, {"driver", device.info().driver},
                      {"git", options.git},           {"width", options.width},
                      {"height", options.height},     {"frames", options.frames},
                      {"most_cost", options.cost}};
    json["cases"] = ordered_json::array();
    json["views"] = ordered_json::array();
    for (const GridResult& result : results) {
        for (const GridCase& grid_case : result.cases)
            json["cases"].push_back(to_json(grid_case, options.cost));
        ordered_json view{
            {"name", result.view->name},           {"scene", result.view->scene},
            {"arguments", result.view->arguments}, {"fragments", result.fragments},
            {"most_layers", result.most_layers},   {"pixels_ambiguous", result.pixels_ambiguous}};
        view["settings"] = ordered_json::array();
        for (const SettingMeasurement& measurement : result.measurements)
            view["settings"].push_back(to_json(measurement));
        json["views"].push_back(std::move(view));
    }
    return json;
}

}  // namespace oit
