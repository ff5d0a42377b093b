#include "budget/chooser.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <map>
#include <span>
#include <utility>

#include "first_line.hpp"
#include "input_error.hpp"
#include "stopwatch.hpp"

namespace oit {
namespace {

using Fate = Candidate::Fate;

// Other formats and sizes make a method faster by no more than packing does `linked`, times this.
// So methods that are slower are left out in all of them.
constexpr double family_margin = 1.2;
// After two draws, a setting is out if it is slower by this; with more draws, by less.
constexpr double first_margin = 1.3;
constexpr int rounds = 3;
// A pass that stores nothing takes this part of one that stores at least: its triangles are the same.
constexpr double part_of_pass = 0.3;

constexpr std::uint64_t all_layers = std::numeric_limits<std::uint64_t>::max();

std::vector<std::uint32_t> layer_counts_of(const std::vector<Setting>& settings) {
    std::vector<std::uint32_t> counts{1};
    for (const Setting& setting : settings) {
        if (setting.quality.layers) counts.push_back(*setting.quality.layers);
        if (setting.quality.size) counts.push_back(*setting.quality.size);
    }
    std::ranges::sort(counts);
    const auto [first, last] = std::ranges::unique(counts);
    counts.erase(first, last);
    return counts;
}

std::vector<float> epsilons_of(const std::vector<Setting>& settings) {
    std::vector<float> epsilons;
    for (const Setting& setting : settings)
        if (setting.quality.epsilon > 0) epsilons.push_back(setting.quality.epsilon);
    if (epsilons.empty()) epsilons.push_back(0.01F);
    return epsilons;
}

// Settings of one method that differ in one number, which the table has in the order of their cost.
enum class Series { none, layers, epsilon, size };

Series series_of(const Setting& setting) {
    if (setting.quality.layers) return Series::layers;
    if (setting.quality.epsilon > 0) return Series::epsilon;
    return setting.quality.size ? Series::size : Series::none;
}

// So many of a series are drawn that meet the budget: more layers may be faster than fewer, for they are
// found in another way.
std::size_t enough_of(Series series) { return series == Series::layers ? 2 : 1; }

// For short frames more draws, up to some time.
int draws_of(double ms, int least) {
    constexpr double enough_ms = 15;
    return std::max(least, std::min(32, static_cast<int>(enough_ms / ms)));
}

PictureError lesser(const PictureError& a, const PictureError& b) {
    return {std::min(a.largest, b.largest), std::min(a.mean_square, b.mean_square)};
}

}  // namespace

/// A setting that is drawn.
struct Chooser::Contender {
    Candidate candidate;
    Frame frame;
    Renderer renderer;
    PictureErrors errors = {};
    support::Least least = {};       ///< until the play-off
    std::vector<double> turns = {};  ///< frame times of the play-off

    Contender(const cellist::Device& device, const Frame& of, const Candidate& drawn)
        : candidate(drawn),
          frame(with_setting(of, drawn.setting)),
          renderer(device, frame, *drawn.setting.method) {}

    [[nodiscard]] double ms() const { return least.ms(); }
    /// Of the first turns.
    [[nodiscard]] double median_ms(std::size_t count) const {
        return support::median({turns.begin(), turns.begin() + static_cast<std::ptrdiff_t>(count)});
    }
};

/// One search: the settings that are left, and what became of the others.
class Chooser::Contest {
public:
    explicit Contest(Chooser& chooser)
        : device_(chooser.device_),
          frame_(chooser.frame_),
          budget_(chooser.budget_),
          search_(chooser.search_),
          survey_(chooser.survey_) {}

    Choice run() {
        search_.progress(0);
        choice_.scene = survey_.measure(frame_);
        choice_.draws = 1;
        const std::vector<Setting> settings = settings_for(frame_, choice_.scene.longest);
        // The exact picture, of which all others are a trade, then all methods at their simplest, then
        // the other settings of those that are fast enough.
        const Setting exact = exact_setting(frame_.quality);
        draw(exact, exact.method->bound(choice_.scene, exact.quality));
        exact_ = contenders_.empty() ? fallback_ : contenders_.front();
        measure_pass();
        std::vector<Setting> in_order{exact}, others;
        for (const Setting& setting : std::span(settings).subspan(1))  // behind the exact one
            if (setting.method == in_order.back().method || setting.method == exact.method)
                others.push_back(setting);
            else
                in_order.push_back(setting);
        in_order.insert(in_order.end(), others.begin(), others.end());
        for (std::size_t i = 1; i < in_order.size(); ++i) {
            search_.progress(static_cast<double>(i) / static_cast<double>(in_order.size()));
            consider(in_order[i]);
        }
        play_off();
        finish();
        search_.progress(1);
        choice_.took_ms = stopwatch_.ms();
        return std::move(choice_);
    }

    std::shared_ptr<Contender> take_winner() { return std::move(winner_); }

private:
    // ---- one setting

    void consider(const Setting& setting) {
        const auto bound = setting.method->bound(choice_.scene, setting.quality);
        Candidate candidate{.setting = setting, .error = bound, .bounded = bound.has_value()};
        // No picture can be told to be nearer to the truth than that which it is compared with.
        if (!budget_.met_by(exact_error())) candidate.fate = Fate::over_budget;
        // A bound of float nodes is what is left out, and little more.
        else if (bound && setting.quality.format == NodeFormat::float32 && !budget_.met_by(*bound))
            candidate.fate = Fate::over_budget;
        // With no fragments all settings draw the same.
        else if (choice_.scene.longest == 0 || has_enough(setting))
            candidate.fate = Fate::not_needed;
        else if (is_predicted_slow(setting))
            candidate.fate = Fate::slower;
        else if (is_over_time())
            candidate.fate = Fate::not_reached;
        else
            return draw(setting, bound);
        choice_.candidates.push_back(candidate);
    }

    [[nodiscard]] const PictureError& exact_error() const {
        return budget_.strict ? choice_.scene.exact_with_order : choice_.scene.exact;
    }

    [[nodiscard]] bool is_over_time() const { return stopwatch_.ms() > 1000 * search_.seconds; }

    [[nodiscard]] bool has_enough(const Setting& setting) const {
        const Series series = series_of(setting);
        if (series == Series::none) return false;
        const auto count = met_.find({setting.method->name, series});
        return count != met_.end() && count->second >= enough_of(series);
    }

    [[nodiscard]] bool is_predicted_slow(const Setting& setting) const {
        // With fewer layers a method may be far faster than with all.
        if (setting.quality.layers || setting.quality.epsilon > 0) return false;
        if (const auto family = family_ms_.find(setting.method->name); family != family_ms_.end())
            return family->second > family_margin * packing_gain_ * best_ms_;
        const auto passes =
            static_cast<double>(setting.method->passes(choice_.scene, setting.quality));
        return passes * part_of_pass * pass_ms_ > family_margin * best_ms_;
    }

    void draw(const Setting& setting, const std::optional<PictureError>& bound) {
        Candidate candidate{.setting = setting};
        std::shared_ptr<Contender> contender;
        bool slower = false;
        try {
            contender = std::make_shared<Contender>(device_, frame_, candidate);
            contender->renderer.warm_up();
            slower = is_slower(*contender, first_margin);
        } catch (const std::exception& error) {
            candidate.fate = Fate::failed;
            candidate.failure = support::first_line(error.what());
            choice_.candidates.push_back(candidate);
            return;
        }
        if (slower) return leave(*contender, Fate::slower);
        compare(*contender, bound);
        if (budget_.met_by(contender->errors)) {
            ++met_[{setting.method->name, series_of(setting)}];
            contenders_.push_back(std::move(contender));
            update_best();
            drop_slower();
            return;
        }
        leave(*contender, Fate::over_budget);
        if (!fallback_ || is_nearer(*contender, *fallback_)) fallback_ = std::move(contender);
    }

    void compare(Contender& contender, const std::optional<PictureError>& bound) {
        contender.errors = survey_.compare(contender.renderer.picture(), budget_.pixel_limit());
        Candidate& candidate = contender.candidate;
        candidate.bounded =
            bound && !budget_.strict && !budget_.better(contender.errors.told, *bound);
        if (bound) contender.errors.told = lesser(contender.errors.told, *bound);
        candidate.error = budget_.counted(contender.errors);
    }

    [[nodiscard]] bool is_nearer(const Contender& a, const Contender& b) const {
        return budget_.better(budget_.counted(a.errors), budget_.counted(b.errors));
    }

    // Draws by turns with the fastest so far, and says whether it is slower by this. What else the
    // machine does disturbs both, but not always alike: it is slower where its least time and that
    // of these turns say so.
    [[nodiscard]] bool is_slower(Contender& contender, double margin) {
        Contender* leader = contenders_.empty() ? nullptr : contenders_.front().get();
        support::Least own, other;
        int draws = 3;
        for (int drawn = 0; drawn < draws; ++drawn) {
            own.add(contender.renderer.draw());
            if (leader) other.add(leader->renderer.draw());
            draws = draws_of(own.ms(), 3);
            choice_.draws += leader ? 2U : 1U;
        }
        contender.least.add(own.ms());
        if (!leader) {
            note(contender, own.ms());
            return false;
        }
        leader->least.add(other.ms());
        contender.candidate.times_leader = own.ms() / other.ms();
        best_ms_ = std::min(best_ms_, other.ms());
        note(*leader, other.ms());
        note(contender, own.ms());
        return own.ms() > margin * other.ms() && is_out(contender, margin);
    }

    void measure_pass() {
        if (!exact_) return;
        support::Least pass;
        for (int i = 0; i < 3; ++i) pass.add(exact_->renderer.draw_by_pass().raster_insert_ms);
        pass_ms_ = std::min(pass.ms(), exact_->ms());
    }

    // What the method takes at least, and what it gains from packing. The first draws of all are
    // slow, so the least of all draws in float counts.
    void note(const Contender& contender, double ms) {
        const Setting& setting = contender.candidate.setting;
        const auto [family, is_new] = family_ms_.try_emplace(setting.method->name, ms);
        family->second = std::min(family->second, ms);
        if (exact_ && setting.method->name == "linked" &&
            setting.quality.format != NodeFormat::float32)
            packing_gain_ = std::max(packing_gain_, exact_->ms() / ms);
    }

    // The fastest comes first.
    void update_best() {
        std::ranges::stable_sort(contenders_, {},
                                 [](const auto& contender) { return contender->ms(); });
        best_ms_ = contenders_.front()->ms();
    }

    // ---- all that are left

    [[nodiscard]] bool is_out(const Contender& contender, double margin) const {
        return contender.ms() > margin * best_ms_;
    }

    void leave(Contender& contender, Fate fate) {
        contender.candidate.fate = fate;
        contender.candidate.fastest_ms = contender.ms();
        choice_.candidates.push_back(contender.candidate);
    }

    // All layers in float are kept for the play-off.
    void drop_slower() {
        std::erase_if(contenders_, [&](const std::shared_ptr<Contender>& contender) {
            if (!is_out(*contender, first_margin) || !is_slower(*contender, first_margin))
                return false;
            if (contender != exact_) leave(*contender, Fate::slower);
            return true;
        });
    }

    // Those that are left draw by turns, so that what else the machine does disturbs all alike.
    // Times from before do not count: they were taken at other moments, and not equally often.
    void play_off() {
        bring_back_exact();
        for (int round = 0; round < rounds; ++round) {
            if (round > 0 && (contenders_.size() < 2 || is_over_time())) return;
            const double least = round == 0 ? best_ms_ : fastest().median_ms;
            draw_by_turns(draws_of(least, std::max(3, 2 << round)), round == 0);
            drop_told_slower(1 + (first_margin - 1) / (2 << round));
        }
    }

    // What others gain is told against all layers in float, so these draw one round at least, even
    // where they were found to be slower before.
    void bring_back_exact() {
        if (!contenders_.empty() && exact_ && budget_.met_by(exact_->errors) &&
            std::ranges::find(contenders_, exact_) == contenders_.end())
            contenders_.push_back(exact_);
    }

    void draw_by_turns(int turns, bool whole) {
        for (int turn = 0; turn < turns; ++turn) {
            if (is_over_time() && !(whole && turn < 3)) return;
            for (const auto& contender : contenders_) {
                contender->turns.push_back(contender->renderer.draw());
                ++choice_.draws;
            }
        }
    }

    [[nodiscard]] Spread fastest() const {
        const auto spread = [](const auto& contender) { return spread_of(contender->turns); };
        return spread_of((*std::ranges::min_element(contenders_, {}, [&](const auto& contender) {
                             return spread(contender).median_ms;
                         }))->turns);
    }

    void drop_told_slower(double margin) {
        if (contenders_.empty()) return;
        const Spread least = fastest();
        std::erase_if(contenders_, [&](const std::shared_ptr<Contender>& contender) {
            const Spread times = spread_of(contender->turns);
            const bool out =
                times.median_ms > margin * least.median_ms && told_slower(times, least);
            if (out) outpaced_.push_back(contender);
            return out;
        });
    }

    void finish() {
        choice_.met = !contenders_.empty();
        if (choice_.met)
            crown();
        else if (fallback_)
            time_fallback();
        else
            throw support::InputError("no setting can be drawn: " +
                                      choice_.candidates.front().failure);
        choice_.setting = winner_->candidate.setting;
        choice_.errors = winner_->errors;
        choice_.bounded = winner_->candidate.bounded;
        choice_.times = spread_of(winner_->turns);
        choice_.turns = static_cast<std::uint32_t>(winner_->turns.size());
        if (exact_ && !exact_->turns.empty()) choice_.exact_times = times_winner(*exact_);
        std::ranges::stable_sort(choice_.candidates, {}, [](const Candidate& candidate) {
            if (candidate.times_chosen) return *candidate.times_chosen;
            return candidate.times_leader.value_or(
                candidate.fastest_ms ? 1.0 : std::numeric_limits<double>::infinity());
        });
    }

    // The candidate dropped out before the turns, so it has no times of turns.
    void time_fallback() {
        winner_ = std::move(fallback_);
        for (int turn = 0; turn < 3; ++turn) winner_->turns.push_back(winner_->renderer.draw());
        choice_.draws += 3;
    }

    void crown() {
        std::vector<Timed> timed;
        for (const auto& contender : contenders_)
            timed.push_back({contender->candidate.setting, spread_of(contender->turns)});
        winner_ = contenders_.at(plainest_of_fastest(timed));
        const Spread least = fastest();
        outpaced_.insert(outpaced_.end(), contenders_.begin(), contenders_.end());
        for (const auto& contender : outpaced_) {
            const Spread times = spread_of(contender->turns);
            contender->candidate.times = times;
            contender->candidate.times_chosen = times_winner(*contender);
            contender->least = {};
            contender->least.add(times.least_ms);
            const bool is_left = std::ranges::find(contenders_, contender) != contenders_.end();
            leave(*contender, contender == winner_                    ? Fate::chosen
                              : is_left && !told_slower(times, least) ? Fate::as_fast
                                                                      : Fate::slower);
        }
    }

    // The ratio in the turns that both drew in.
    [[nodiscard]] double times_winner(const Contender& contender) const {
        const std::size_t turns = contender.turns.size();
        return contender.median_ms(turns) / winner_->median_ms(turns);
    }

    const cellist::Device& device_;
    const Frame& frame_;
    const Budget& budget_;
    const SearchOptions& search_;
    const support::Stopwatch stopwatch_{};
    Survey& survey_;
    Choice choice_;
    std::vector<std::shared_ptr<Contender>> contenders_;  // within the budget
    std::vector<std::shared_ptr<Contender>> outpaced_;    // in the play-off
    std::shared_ptr<Contender> fallback_;                 // the most accurate of the others
    std::shared_ptr<Contender> exact_;                    // all layers in float, where drawn
    std::shared_ptr<Contender> winner_;
    double best_ms_ = std::numeric_limits<double>::infinity();
    double packing_gain_ = 1;  // of `linked`: how many times as fast it gets
    double pass_ms_ = 0;       // to draw and store all fragments once
    std::map<std::string_view, double> family_ms_;
    std::map<std::pair<std::string_view, Series>, std::size_t> met_;
};

Chooser::Chooser(const cellist::Device& device, const Frame& frame, const Budget& budget,
                 SearchOptions search)
    : device_(device),
      frame_(frame),
      budget_(budget),
      search_(std::move(search)),
      survey_(device, frame, layer_counts_of(settings_for(frame, all_layers)),
              epsilons_of(settings_for(frame, all_layers))) {}

Chooser::~Chooser() = default;

Choice Chooser::choose() {
    winner_.reset();
    Contest contest(*this);
    Choice choice = contest.run();
    winner_ = contest.take_winner();
    return choice;
}

double Chooser::draw_changed() {
    winner_->frame.time = frame_.time;
    winner_->frame.views = frame_.views;
    return winner_->renderer.draw_changed();
}

PictureErrors Chooser::check() {
    const SceneMeasure scene = survey_.measure(frame_);
    const Setting& setting = winner_->candidate.setting;
    PictureErrors errors = survey_.compare(winner_->renderer.picture(), budget_.pixel_limit());
    if (const auto bound = setting.method->bound(scene, setting.quality))
        errors.told = lesser(errors.told, *bound);
    return errors;
}

Renderer& Chooser::renderer() const { return winner_->renderer; }

}  // namespace oit
