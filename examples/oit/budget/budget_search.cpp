// SPDX-License-Identifier: MIT
#include "budget/budget_search.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <map>
#include <span>
#include <utility>

#include "budget/final_rounds.hpp"
#include "first_line.hpp"
#include "input_error.hpp"
#include "stopwatch.hpp"

namespace oit {
namespace {

using Outcome = Candidate::Outcome;

// Other formats and sizes make a method faster by no more than packing makes `linked`, times this.
// So all settings of a method that is slower than that are left out.
constexpr double method_margin = 1.2;
// A pass that stores nothing takes this part of one that stores at least: its triangles are the
// same.
constexpr double part_of_pass = 0.3;

constexpr std::uint64_t all_layers = std::numeric_limits<std::uint64_t>::max();

std::vector<std::uint32_t> layer_counts_of(const std::vector<Setting>& settings) {
    std::vector<std::uint32_t> counts{1};
    for (const Setting& setting : settings) {
        if (setting.quality.layers) counts.push_back(*setting.quality.layers);
        if (setting.quality.size) counts.push_back(*setting.quality.size);
    }
    std::ranges::sort(counts);
    counts.erase(std::unique(counts.begin(), counts.end()), counts.end());
    return counts;
}

std::vector<float> epsilons_of(const std::vector<Setting>& settings) {
    std::vector<float> epsilons;
    for (const Setting& setting : settings)
        if (setting.quality.epsilon > 0) epsilons.push_back(setting.quality.epsilon);
    if (epsilons.empty()) epsilons.push_back(0.01F);
    return epsilons;
}

// Settings of one method that differ in one number. The table has them in the order of their cost.
enum class Series { none, layers, epsilon, size };

Series series_of(const Setting& setting) {
    if (setting.quality.layers) return Series::layers;
    if (setting.quality.epsilon > 0) return Series::epsilon;
    return setting.quality.size ? Series::size : Series::none;
}

// How many settings of a series are drawn that meet the budget. More layers may be faster than
// fewer, because another algorithm finds them.
std::size_t enough_of(Series series) { return series == Series::layers ? 2 : 1; }

PictureError lesser(const PictureError& a, const PictureError& b) {
    return {std::min(a.largest, b.largest), std::min(a.mean_square, b.mean_square)};
}

}  // namespace

/// One search: the settings that are left, and the outcomes of the others.
class BudgetSearch::Search {
public:
    explicit Search(BudgetSearch& owner)
        : device_(owner.device_),
          frame_(owner.frame_),
          budget_(owner.budget_),
          options_(owner.options_),
          survey_(owner.survey_) {}

    Choice run() {
        options_.progress(0);
        choice_.scene = survey_.measure(frame_);
        choice_.draws = 1;
        const std::vector<Setting> settings = settings_for(frame_, choice_.scene.longest);
        // First the exact picture, which all others trade for speed. Then all methods at their
        // simplest, then the other settings of the methods that are fast enough.
        const Setting exact = exact_setting(frame_.quality);
        draw(exact, exact.method->bound(choice_.scene, exact.quality));
        exact_ = within_.empty() ? most_accurate_ : within_.front();
        measure_pass();
        std::vector<Setting> in_order{exact}, others;
        for (const Setting& setting : std::span(settings).subspan(1))  // after the exact one
            if (setting.method == in_order.back().method || setting.method == exact.method)
                others.push_back(setting);
            else
                in_order.push_back(setting);
        in_order.insert(in_order.end(), others.begin(), others.end());
        for (std::size_t i = 1; i < in_order.size(); ++i) {
            options_.progress(static_cast<double>(i) / static_cast<double>(in_order.size()));
            consider(in_order[i]);
        }
        choose();
        options_.progress(1);
        choice_.took_ms = stopwatch_.ms();
        return std::move(choice_);
    }

    std::shared_ptr<DrawnSetting> take_chosen() { return std::move(chosen_); }

private:
    // ---- one setting

    void consider(const Setting& setting) {
        const auto bound = setting.method->bound(choice_.scene, setting.quality);
        Candidate candidate{.setting = setting, .error = bound, .bounded = bound.has_value()};
        // No picture can be shown to be nearer to the truth than the picture it is compared with.
        if (!budget_.met_by(exact_error())) candidate.outcome = Outcome::over_budget;
        // A bound of float nodes is what is left out, and little more.
        else if (bound && setting.quality.format == NodeFormat::float32 && !budget_.met_by(*bound))
            candidate.outcome = Outcome::over_budget;
        // With no fragments all settings draw the same.
        else if (choice_.scene.longest == 0 || has_enough(setting))
            candidate.outcome = Outcome::not_needed;
        else if (is_predicted_slow(setting))
            candidate.outcome = Outcome::slower;
        else if (is_over_time())
            candidate.outcome = Outcome::not_reached;
        else
            return draw(setting, bound);
        choice_.candidates.push_back(candidate);
    }

    [[nodiscard]] const PictureError& exact_error() const {
        return budget_.strict ? choice_.scene.exact_with_order : choice_.scene.exact;
    }

    [[nodiscard]] bool is_over_time() const { return stopwatch_.ms() > 1000 * options_.seconds; }

    [[nodiscard]] bool has_enough(const Setting& setting) const {
        const Series series = series_of(setting);
        if (series == Series::none) return false;
        const auto count = met_.find({setting.method->name, series});
        return count != met_.end() && count->second >= enough_of(series);
    }

    [[nodiscard]] bool is_predicted_slow(const Setting& setting) const {
        // With fewer layers a method may be far faster than with all.
        if (setting.quality.layers || setting.quality.epsilon > 0) return false;
        if (const auto method = method_ms_.find(setting.method->name); method != method_ms_.end())
            return method->second > method_margin * packing_gain_ * best_ms_;
        const auto passes =
            static_cast<double>(setting.method->passes(choice_.scene, setting.quality));
        return passes * part_of_pass * pass_ms_ > method_margin * best_ms_;
    }

    void draw(const Setting& setting, const std::optional<PictureError>& bound) {
        std::shared_ptr<DrawnSetting> drawn;
        bool slower = false;
        try {
            drawn = std::make_shared<DrawnSetting>(device_, frame_, setting);
            drawn->renderer.warm_up();
            slower = draw_against_fastest(*drawn);
        } catch (const std::exception& error) {
            choice_.candidates.push_back({.setting = setting,
                                          .outcome = Outcome::failed,
                                          .failure = support::first_line(error.what())});
            return;
        }
        if (slower) return drop(*drawn, Outcome::slower);
        compare(*drawn, bound);
        if (budget_.met_by(drawn->errors)) {
            ++met_[{setting.method->name, series_of(setting)}];
            within_.push_back(std::move(drawn));
            sort_by_time();
            drop_slower();
            return;
        }
        drop(*drawn, Outcome::over_budget);
        if (!most_accurate_ ||
            budget_.better(budget_.counted(drawn->errors), budget_.counted(most_accurate_->errors)))
            most_accurate_ = std::move(drawn);
    }

    void compare(DrawnSetting& drawn, const std::optional<PictureError>& bound) {
        drawn.errors = survey_.compare(drawn.renderer.picture(), budget_.pixel_limit());
        Candidate& candidate = drawn.candidate;
        candidate.bounded =
            bound && !budget_.strict && !budget_.better(drawn.errors.resolved, *bound);
        if (bound) drawn.errors.resolved = lesser(drawn.errors.resolved, *bound);
        candidate.error = budget_.counted(drawn.errors);
    }

    // Draws interleaved with the fastest so far, and returns whether the setting is slower by the
    // first margin. Other work on the machine disturbs both, but not always alike: the setting is
    // slower only if both its least time so far and that of these draws say so.
    bool draw_against_fastest(DrawnSetting& drawn) {
        DrawnSetting* fastest = within_.empty() ? nullptr : within_.front().get();
        support::Least own, other;
        int draws = 3;
        for (int i = 0; i < draws; ++i) {
            own.add(drawn.renderer.draw());
            if (fastest) other.add(fastest->renderer.draw());
            draws = draws_of(own.ms(), 3);
            choice_.draws += fastest ? 2U : 1U;
        }
        drawn.least.add(own.ms());
        if (!fastest) {
            note(drawn, own.ms());
            return false;
        }
        fastest->least.add(other.ms());
        drawn.candidate.times_fastest = own.ms() / other.ms();
        best_ms_ = std::min(best_ms_, other.ms());
        note(*fastest, other.ms());
        note(drawn, own.ms());
        return own.ms() > first_margin * other.ms() && is_out(drawn);
    }

    void measure_pass() {
        if (!exact_) return;
        support::Least pass;
        for (int i = 0; i < 3; ++i) pass.add(exact_->renderer.draw_by_pass().raster_insert_ms);
        pass_ms_ = std::min(pass.ms(), exact_->ms());
    }

    // Notes the least time of the method, and what it gains from packing. The first draws of all
    // are slow, so the least of all draws in float counts.
    void note(const DrawnSetting& drawn, double ms) {
        const Setting& setting = drawn.candidate.setting;
        const auto [method, is_new] = method_ms_.try_emplace(setting.method->name, ms);
        method->second = std::min(method->second, ms);
        if (exact_ && setting.method->name == "linked" &&
            setting.quality.format != NodeFormat::float32)
            packing_gain_ = std::max(packing_gain_, exact_->ms() / ms);
    }

    // ---- all settings that are left

    // The fastest comes first.
    void sort_by_time() {
        std::ranges::stable_sort(within_, {}, [](const auto& drawn) { return drawn->ms(); });
        best_ms_ = within_.front()->ms();
    }

    [[nodiscard]] bool is_out(const DrawnSetting& drawn) const {
        return drawn.ms() > first_margin * best_ms_;
    }

    void drop(DrawnSetting& drawn, Outcome outcome) {
        drawn.candidate.outcome = outcome;
        drawn.candidate.fastest_ms = drawn.ms();
        choice_.candidates.push_back(drawn.candidate);
    }

    // All layers in float stay for the final rounds.
    void drop_slower() {
        std::erase_if(within_, [&](const std::shared_ptr<DrawnSetting>& drawn) {
            if (!is_out(*drawn) || !draw_against_fastest(*drawn)) return false;
            if (drawn != exact_) drop(*drawn, Outcome::slower);
            return true;
        });
    }

    void choose() {
        choice_.met = !within_.empty();
        if (choice_.met)
            draw_final_rounds();
        else if (most_accurate_)
            time_most_accurate();
        else
            throw support::InputError("no setting can be drawn: " +
                                      choice_.candidates.front().failure);
        choice_.setting = chosen_->candidate.setting;
        choice_.errors = chosen_->errors;
        choice_.bounded = chosen_->candidate.bounded;
        choice_.times = spread_of(chosen_->times_ms);
        choice_.timed_frames = static_cast<std::uint32_t>(chosen_->times_ms.size());
        if (exact_ && !exact_->times_ms.empty()) choice_.exact_times = exact_->times(*chosen_);
        std::ranges::stable_sort(choice_.candidates, {}, [](const Candidate& candidate) {
            if (candidate.times_chosen) return *candidate.times_chosen;
            return candidate.times_fastest.value_or(
                candidate.fastest_ms ? 1.0 : std::numeric_limits<double>::infinity());
        });
    }

    // The gain of the others is relative to all layers in float, so these draw at least one round,
    // even if they were slower before.
    void draw_final_rounds() {
        if (exact_ && budget_.met_by(exact_->errors) &&
            std::ranges::find(within_, exact_) == within_.end())
            within_.push_back(exact_);
        FinalRounds rounds(std::move(within_), [this] { return is_over_time(); });
        choice_.draws += rounds.draw(best_ms_);
        chosen_ = rounds.choose();
        for (const auto& drawn : rounds.settings()) choice_.candidates.push_back(drawn->candidate);
    }

    // It dropped out before the final rounds, so it has no times of these.
    void time_most_accurate() {
        chosen_ = std::move(most_accurate_);
        for (int i = 0; i < 3; ++i) chosen_->times_ms.push_back(chosen_->renderer.draw());
        choice_.draws += 3;
    }

    const cellist::Device& device_;
    const Frame& frame_;
    const Budget& budget_;
    const SearchOptions& options_;
    const support::Stopwatch stopwatch_{};
    Survey& survey_;
    Choice choice_;
    DrawnSettings within_;                         // the budget, fastest first
    std::shared_ptr<DrawnSetting> most_accurate_;  // of the others
    std::shared_ptr<DrawnSetting> exact_;          // all layers in float, where drawn
    std::shared_ptr<DrawnSetting> chosen_;
    double best_ms_ = std::numeric_limits<double>::infinity();
    double packing_gain_ = 1;  // of `linked`: how many times as fast it gets
    double pass_ms_ = 0;       // to draw and store all fragments once
    std::map<std::string_view, double> method_ms_;
    std::map<std::pair<std::string_view, Series>, std::size_t> met_;
};

BudgetSearch::BudgetSearch(const cellist::Device& device, const Frame& frame, const Budget& budget,
                           SearchOptions options)
    : device_(device),
      frame_(frame),
      budget_(budget),
      options_(std::move(options)),
      survey_(device, frame, layer_counts_of(settings_for(frame, all_layers)),
              epsilons_of(settings_for(frame, all_layers))) {}

BudgetSearch::~BudgetSearch() = default;

Choice BudgetSearch::run() {
    chosen_.reset();
    Search search(*this);
    Choice choice = search.run();
    chosen_ = search.take_chosen();
    return choice;
}

double BudgetSearch::draw_changed() {
    chosen_->frame.time = frame_.time;
    chosen_->frame.views = frame_.views;
    return chosen_->renderer.draw_changed();
}

PictureErrors BudgetSearch::check() {
    const SurveyResult scene = survey_.measure(frame_);
    const Setting& setting = chosen_->candidate.setting;
    PictureErrors errors = survey_.compare(chosen_->renderer.picture(), budget_.pixel_limit());
    if (const auto bound = setting.method->bound(scene, setting.quality))
        errors.resolved = lesser(errors.resolved, *bound);
    return errors;
}

Renderer& BudgetSearch::renderer() const { return chosen_->renderer; }

}  // namespace oit
