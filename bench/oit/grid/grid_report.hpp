#pragma once

#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "budget/chooser.hpp"
#include "cases.hpp"
#include "grid_options.hpp"
#include "search.hpp"

namespace oit {

/// A budget for a view: what was chosen, and what is best.
struct GridCase {
    std::string name;
    Budget budget;
    Choice choice = {};
    Trial chosen = {};               ///< as it was measured beside the best one
    std::optional<Trial> best = {};  ///< none where no setting keeps the budget
    double cost = 1;                 ///< median of the chosen one, in medians of the best one

    /// What was promised is true: an error within the budget, or that no setting has one.
    [[nodiscard]] bool kept() const;
    /// And at no more than this cost.
    [[nodiscard]] bool met(double most_cost) const { return kept() && cost <= most_cost; }
};

/// A view, all its settings and its cases.
struct GridResult {
    const GridView* view;
    std::uint64_t fragments = 0;
    std::uint64_t most_layers = 0;
    std::uint64_t pixels_ambiguous = 0;
    std::vector<Trial> trials = {};
    std::vector<GridCase> cases = {};
};

/// Two lines.
void print(const GridCase& grid_case, double most_cost, std::ostream& out);

/// All figures; a PSNR that is infinite is null.
[[nodiscard]] nlohmann::ordered_json to_json(const std::vector<GridResult>& results,
                                             const GridOptions& options,
                                             const cellist::Device& device);

}  // namespace oit
