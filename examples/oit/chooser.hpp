#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <cellist/cellist.hpp>

#include "budget.hpp"
#include "renderer.hpp"
#include "setting.hpp"
#include "spread.hpp"
#include "survey.hpp"

namespace oit {

/// A setting that was looked at for a budget.
struct Candidate {
    enum class Fate {
        chosen,
        over_budget,
        as_fast,      ///< as the fastest, as far as times tell; the chosen one is plainer
        slower,       ///< than the chosen one
        not_needed,   ///< a setting that gives up more meets the budget
        failed,       ///< the device cannot draw it
        not_reached,  ///< the time for the search was over
    };
    Setting setting;
    Fate fate = Fate::slower;
    std::optional<PictureError> error = {};  ///< at most, where it is known: see Budget::counted
    bool bounded = false;                    ///< by theory, or else by comparing the picture
    std::optional<double> fastest_ms = {};   ///< a frame, where it was drawn
    /// As long as the leader of that moment took, by turns: says more than times of other moments.
    std::optional<double> times_leader = {};
    /// Of those that drew by turns with the chosen one in the end: their times, and how long they
    /// took against it in the median of the turns that both had.
    std::optional<Spread> times = {};
    std::optional<double> times_chosen = {};
    std::string failure = {};
};

/// What a budget led to.
struct Choice {
    bool met = false;
    Setting setting;            ///< where no setting meets the budget, the most accurate one
    PictureErrors errors = {};  ///< its errors, at most
    bool bounded = false;       ///< as Candidate::bounded
    Spread times = {};          ///< of its frames
    std::uint32_t turns = 0;    ///< frames that these are of
    /// As long as this takes exact_setting(), by turns: 1 where that was chosen.
    std::optional<double> exact_times = {};
    SceneMeasure scene = {};
    std::vector<Candidate> candidates = {};  ///< the fastest first, then those that were not drawn
    std::uint32_t draws = 0;  ///< frames that were drawn to find it, the survey's included
    double took_ms = 0;

    [[nodiscard]] std::uint64_t count(Candidate::Fate fate) const {
        return static_cast<std::uint64_t>(std::ranges::count(candidates, fate, &Candidate::fate));
    }
};

/// How a search is watched and limited.
struct SearchOptions {
    /// Is told how far the search is, from 0 to 1.
    std::function<void(double)> progress = [](double) {};
    /// After this time no other setting is looked at. All layers in float are, and the play-off has
    /// three turns.
    double seconds = 120;
};

/// Finds the cheapest setting within a budget, for a frame on a device. In the end the settings
/// that are left draw by turns, so that what else the machine does falls to all of them.
/// plainest_of_fastest() chooses one by these times.
class Chooser {
public:
    /// Refers to the device and the frame, which must outlive it. Samples and how depths are scaled
    /// are the frame's; its format, size, layers and epsilon do not matter.
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
