// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <cellist/cellist.hpp>

#include "budget/budget.hpp"
#include "budget/setting.hpp"
#include "budget/spread.hpp"
#include "budget/survey.hpp"
#include "methods/renderer.hpp"

namespace oit {

struct DrawnSetting;

/// A setting that a search considered for a budget.
struct Candidate {
    enum class Outcome {
        chosen,
        over_budget,
        as_fast,      ///< not measurably slower than the fastest; the chosen setting is plainer
        slower,       ///< slower than the chosen setting
        not_needed,   ///< a setting that gives up more meets the budget
        failed,       ///< the device cannot draw it
        not_reached,  ///< the search ran out of time
    };
    Setting setting;
    Outcome outcome = Outcome::slower;
    std::optional<PictureError> error = {};  ///< at most, where it is known: see Budget::counted
    bool bounded = false;                    ///< by theory, or else by comparing the picture
    std::optional<double> fastest_ms = {};   ///< a frame, where it was drawn
    /// How many times as long as the fastest setting so far it took, with interleaved draws.
    std::optional<double> times_fastest = {};
    /// Of settings in the final rounds: their times, and the ratio of medians to the chosen setting
    /// over the frames that both drew.
    std::optional<Spread> times = {};
    std::optional<double> times_chosen = {};
    std::string failure = {};
};

/// The result of a search.
struct Choice {
    bool met = false;
    Setting setting;                 ///< the most accurate one, if no setting meets the budget
    PictureErrors errors = {};       ///< bounds of its errors
    bool bounded = false;            ///< as Candidate::bounded
    Spread times = {};               ///< of its frames
    std::uint32_t timed_frames = 0;  ///< number of these frames
    /// How many times as long exact_setting() takes, interleaved with the chosen one; 1 if it was
    /// chosen.
    std::optional<double> exact_times = {};
    SurveyResult scene = {};
    std::vector<Candidate> candidates = {};  ///< fastest first; those that were not drawn come last
    std::uint32_t draws = 0;  ///< frames that were drawn to find it, the survey's included
    double took_ms = 0;

    [[nodiscard]] std::uint64_t count(Candidate::Outcome outcome) const {
        return static_cast<std::uint64_t>(
            std::ranges::count(candidates, outcome, &Candidate::outcome));
    }
};

/// How a search is watched and limited.
struct SearchOptions {
    /// Called with the progress of the search, from 0 to 1.
    std::function<void(double)> progress = [](double) {};
    /// After this time the search draws no new setting, except all layers in float. The final
    /// rounds then draw three frames of each setting.
    double seconds = 120;
};

/// Finds the cheapest setting within a budget, for a frame on a device. Each setting draws
/// interleaved with the fastest so far; the settings that remain draw the FinalRounds.
class BudgetSearch {
public:
    /// Refers to the device and the frame, which must outlive it. Takes samples and the depth scale
    /// from the frame, and ignores its format, size, layers and epsilon.
    BudgetSearch(const cellist::Device& device, const Frame& frame, const Budget& budget,
                 SearchOptions options);
    ~BudgetSearch();

    /// Surveys the frame as it is now, in time and views, and chooses. Blocks, for some dozens of
    /// frames and for building the kernels of settings that are new.
    Choice run();

    /// Draws the frame, which now has another time or other views, with what was chosen.
    double draw_changed();
    /// Surveys the frame as it is now, and compares what was drawn of it. Blocks.
    [[nodiscard]] PictureErrors check();

    /// Draws with what was chosen, after run().
    [[nodiscard]] Renderer& renderer() const;
    [[nodiscard]] const Frame& frame() const { return frame_; }

private:
    class Search;

    const cellist::Device& device_;
    const Frame& frame_;
    Budget budget_;
    SearchOptions options_;
    Survey survey_;
    std::shared_ptr<DrawnSetting> chosen_;
};

}  // namespace oit
