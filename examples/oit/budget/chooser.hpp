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

/// A setting that was looked at for a budget.
struct Candidate {
    enum class Fate {
        chosen,
        over_budget,
        as_fast,      ///< its times do not differ from the fastest; the chosen setting is plainer
        slower,       ///< slower than the chosen setting
        not_needed,   ///< a setting that gives up more meets the budget
        failed,       ///< the device cannot draw it
        not_reached,  ///< the search ran out of time
    };
    Setting setting;
    Fate fate = Fate::slower;
    std::optional<PictureError> error = {};  ///< at most, where it is known: see Budget::counted
    bool bounded = false;                    ///< by theory, or else by comparing the picture
    std::optional<double> fastest_ms = {};   ///< a frame, where it was drawn
    /// As long as the leader of that moment took, by turns: says more than times of other moments.
    std::optional<double> times_leader = {};
    /// For settings that drew by turns with the chosen one at the end: their times, and their median
    /// ratio to the chosen setting in the turns that both drew in.
    std::optional<Spread> times = {};
    std::optional<double> times_chosen = {};
    std::string failure = {};
};

/// What a budget led to.
struct Choice {
    bool met = false;
    Setting setting;            ///< the most accurate one, if no setting meets the budget
    PictureErrors errors = {};  ///< bounds of its errors
    bool bounded = false;       ///< as Candidate::bounded
    Spread times = {};          ///< of its frames
    std::uint32_t turns = 0;    ///< number of these frames
    /// As long as this takes exact_setting(), by turns: 1 where that was chosen.
    std::optional<double> exact_times = {};
    SceneMeasure scene = {};
    std::vector<Candidate> candidates = {};  ///< fastest first; those that were not drawn come last
    std::uint32_t draws = 0;  ///< frames that were drawn to find it, the survey's included
    double took_ms = 0;

    [[nodiscard]] std::uint64_t count(Candidate::Fate fate) const {
        return static_cast<std::uint64_t>(std::ranges::count(candidates, fate, &Candidate::fate));
    }
};

/// How a search is watched and limited.
struct SearchOptions {
    /// Called with the progress of the search, from 0 to 1.
    std::function<void(double)> progress = [](double) {};
    /// After this time the search draws no new setting, except all layers in float. The play-off then has
    /// three turns.
    double seconds = 120;
};

/// Finds the cheapest setting within a budget, for a frame on a device. At the end the remaining settings
/// draw by turns, so that other work on the machine slows all of them alike. plainest_of_fastest()
/// chooses one by these times.
class Chooser {
public:
    /// Refers to the device and the frame, which must outlive it. Takes samples and the depth scale from
    /// the frame, and ignores its format, size, layers and epsilon.
    Chooser(const cellist::Device& device, const Frame& frame, const Budget& budget,
            SearchOptions search);
    ~Chooser();

    /// Surveys the frame as it is now, in time and views, and chooses. Blocks, for some dozens of
    /// frames and for building the kernels of settings that are new.
    Choice choose();

    /// Draws the frame, which now has another time or other views, with what was chosen.
    double draw_changed();
    /// Surveys the frame as it is now, and compares what was drawn of it. Blocks.
    [[nodiscard]] PictureErrors check();

    /// Draws with what was chosen, after choose().
    [[nodiscard]] Renderer& renderer() const;
    [[nodiscard]] const Frame& frame() const { return frame_; }

private:
    class Contest;
    struct Contender;

    const cellist::Device& device_;
    const Frame& frame_;
    Budget budget_;
    SearchOptions search_;
    Survey survey_;
    std::shared_ptr<Contender> winner_;
};

}  // namespace oit
