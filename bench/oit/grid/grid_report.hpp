// SPDX-License-Identifier: MIT
#pragma once

#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "budget/budget_search.hpp"
#include "cases.hpp"
#include "grid_options.hpp"
#include "search.hpp"

namespace oit {

/// A budget for a view, the chosen setting, and the best setting.
struct GridCase {
    std::string name;
    Budget budget;
    Choice choice = {};
    SettingMeasurement chosen = {};               ///< as it was measured beside the best one
    std::optional<SettingMeasurement> best = {};  ///< none where no setting keeps the budget
    double cost = 1;  ///< median of the chosen one, in medians of the best one

    /// Whether the promise is true: the error is within the budget, or no setting can meet it.
    [[nodiscard]] bool kept() const;
    /// Whether the case passes: it is kept, and costs at most `most_cost` times the best setting.
    [[nodiscard]] bool met(double most_cost) const { return kept() && cost <= most_cost; }
};

/// A view, all its settings and its cases.
struct GridResult {
    const GridView* view;
    std::uint64_t fragments = 0;
    std::uint64_t most_layers = 0;
    std::uint64_t pixels_ambiguous = 0;
    std::vector<SettingMeasurement> measurements = {};
    std::vector<GridCase> cases = {};
};

/// Two lines.
void print(const GridCase& grid_case, double most_cost, std::ostream& out);

/// All figures; a PSNR that is infinite is null.
[[nodiscard]] nlohmann::ordered_json to_json(const std::vector<GridResult>& results,
                                             const GridOptions& options,
                                             const cellist::Device& device);

}  // namespace oit
