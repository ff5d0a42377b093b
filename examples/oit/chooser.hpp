#pragma once

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
#include "survey.hpp"

namespace oit {

/// A setting that was looked at for a budget.
struct Candidate {
    enum class Fate {
        chosen,
        over_budget,
        as_fast,     ///< as the chosen one, within Chooser::as_fast, and no more accurate
        slower,      ///< than the chosen one
        not_needed,  ///< a setting that gives up more meets the budget
        failed,      ///< the device cannot draw it
    };
    Setting setting;
    Fate fate = Fate::slower;
    std::optional<PictureError> error =
        {};                                 ///< at most, where it is known: see PictureErrors::told
    bool bounded = false;                   ///< by theory, or else by comparing the picture
    std::optional<double> fastest_ms = {};  ///< a frame, where it was drawn
    /// As long as the leader of that moment took, by turns: says more than times of other moments.
    std::optional<double> times_leader = {};
    /// As long as the chosen one took, of those that drew by turns with it in the end.
    std::optional<double> times_chosen = {};
    std::string failure = {};
};

/// What a budget led to.
struct Choice {
    bool met = false;
    Setting setting;        ///< where no setting meets the budget, the most accurate one
    PictureErrors errors;   ///< its errors, at most
    bool bounded = false;   ///< as Candidate::bounded
    double fastest_ms = 0;  ///< of a frame
    /// As long as this takes exact_setting(), by turns: 1 where that was chosen.
    std::optional<double> exact_times = {};
    SceneMeasure scene;
    std::vector<Candidate> candidates;  ///< the fastest first, then those that were not drawn
    std::uint32_t draws = 0;  ///< frames that were drawn to find it, the survey's included
    double took_ms = 0;
};

/// Finds the cheapest setting within a budget, for a frame on a device.
///
/// Frame times are the least of several draws, in which the settings that are left take turns. A setting
/// within 3 % of the fastest is as fast; of these, the most accurate is chosen.
class Chooser {
public:
    static constexpr double as_fast = 1.03;

    /// Refers to the device and the frame, which must outlive it. Samples and how depths are scaled are
    /// the frame's; its format, size, layers and epsilon do not matter. `progress` is told how far a
    /// search is, from 0 to 1.
    Chooser(const cellist::Device& device, const Frame& frame, const Budget& budget,
            std::function<void(double)> progress);
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
    std::function<void(double)> progress_;
    Survey survey_;
    std::shared_ptr<Contender> winner_;
};

}  // namespace oit
