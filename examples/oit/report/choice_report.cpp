// SPDX-License-Identifier: MIT
#include "report/choice_report.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "number_text.hpp"

namespace oit {
namespace {

using Outcome = Candidate::Outcome;

std::string percent(double part) {
    return support::fixed(100 * part, 100 * part < 1 && part > 0 ? 3 : 1) + " %";
}

// Without what is the same for all.
std::string short_text(const Setting& setting) {
    Setting alone = setting;
    const Quality usual;
    alone.quality.samples = usual.samples;
    alone.quality.resolve = usual.resolve;
    alone.quality.depth_range = usual.depth_range;
    alone.quality.depth_scale = usual.depth_scale;
    return text(alone);
}

// Half of the pixels that have layers have no more than this.
std::uint64_t median_layers(const SurveyResult& scene) {
    std::uint64_t seen = 0;
    for (std::size_t bin = 1; bin < scene.pixels_by_layers.size(); ++bin) {
        seen += scene.pixels_by_layers[bin];
        if (2 * seen >= scene.nonempty_pixels) return std::min((1UL << bin) - 1, scene.longest);
    }
    return scene.longest;
}

std::string layers_text(const SurveyResult& scene) {
    if (scene.fragments == 0) return "nothing transparent is visible";
    return support::counted(scene.fragments, "fragment") + " in " +
           percent(static_cast<double>(scene.nonempty_pixels) / static_cast<double>(scene.pixels)) +
           " of the pixels, half of these with " + support::counted(median_layers(scene), "layer") +
           " at most, the deepest with " + support::grouped(scene.longest);
}

std::string light_text(const SurveyResult& scene) {
    std::string text;
    for (const SurveyResult::Cut& cut : scene.cuts)
        if (cut.layers >= 2 && cut.layers < scene.longest)
            text += (text.empty() ? "" : ", ") + percent(cut.light_behind) + " behind " +
                    std::to_string(cut.layers) + (text.empty() ? " layers" : "");
    return text.empty() ? "" : "in any pixel at most " + text;
}

std::string unresolved_text(const SurveyResult& scene) {
    const auto& [of_float, of_24, of_16] = scene.pixels_unresolved;
    if (of_float + of_24 + of_16 == 0) return "resolved in all pixels, even with depths of 16 bits";
    return "not resolved in " + support::counted(of_float, "pixel") + " with float depths, in " +
           support::grouped(of_24) + " with 24 bits, in " + support::grouped(of_16) +
           " with 16 bits";
}

std::string reason(const Candidate& candidate) {
    switch (candidate.outcome) {
        case Outcome::chosen:
            return "chosen";
        case Outcome::over_budget:
            return "over the budget";
        case Outcome::as_fast:
            return "as fast, not as plain";
        case Outcome::slower:
            return candidate.fastest_ms ? "slower" : "expected to be slower, not drawn";
        case Outcome::not_needed:
            return "not needed";
        case Outcome::failed:
            return "failed";
        case Outcome::not_reached:
            return "not reached in time";
    }
    return {};
}

const char* basis(bool bounded) {
    return bounded ? "by its bound"
                   : "compared with all layers in float, including the error of "
                     "that picture";
}

// "41.3 dB at least" or "0.71/255 at most".
std::string limit_text(const PictureError& error, const Budget& budget) {
    return budget.text_of(error) + (budget.kind == Budget::Kind::psnr ? " at least" : " at most");
}

std::string other_order_text(const Choice& choice, const Budget& budget) {
    const bool counts = budget.strict, is_psnr = budget.kind == Budget::Kind::psnr;
    return "in " + support::counted(choice.scene.pixels_unresolved[0], "undecided pixel") +
           " float does not tell the order of layers: " +
           (counts ? "apart from these, " : "with the other order there, ") +
           limit_text(counts ? choice.errors.resolved : choice.errors.all, budget) +
           (counts || is_psnr || choice.errors.undecided_pixels == 0
                ? ""
                : ", over " + budget.text() + " in " +
                      support::grouped(choice.errors.undecided_pixels));
}

// Where all layers in float were chosen, there is nothing to compare.
std::string speed_text(const Choice& choice) {
    const bool is_exact = text(choice.setting) == text(exact_setting(choice.setting.quality));
    if (!choice.met || !choice.exact_times || is_exact) return {};
    return "all layers in float take " + support::fixed(*choice.exact_times, 2) + " times as long";
}

// "12.1 to 13.4 ms"
std::string quartiles_text(const Spread& times) {
    return support::fixed(times.lower_quartile_ms, 2) + " to " +
           support::fixed(times.upper_quartile_ms, 2) + " ms";
}

std::string chosen_text(const Choice& choice) {
    return short_text(choice.setting) + ": " + support::fixed(choice.times.median_ms, 2) +
           " ms (half of " + support::counted(choice.timed_frames, "frame") + " in " +
           quartiles_text(choice.times) + ")";
}

// Why this setting was chosen, where times alone do not decide.
std::string plainest_text(const Choice& choice) {
    const std::uint64_t others = choice.count(Outcome::as_fast);
    if (others == 0) return {};
    return std::string(others == 1 ? "one other setting is"
                                   : support::grouped(others) + " other settings are") +
           " as fast, within the spread of the times: the plainest is chosen";
}

std::string search_text(const Choice& choice) {
    std::string text = support::counted(choice.candidates.size(), "setting") + ", " +
                       support::counted(choice.draws, "frame") + ", " +
                       support::fixed(choice.took_ms / 1000, 1) + " s";
    if (const std::uint64_t left = choice.count(Outcome::not_reached); left > 0)
        text += "; the time limit left out " + support::counted(left, "setting") +
                ": raise --search-seconds";
    return text;
}

// ---- the settings that were not chosen

std::vector<const Candidate*> others_of(const Choice& choice) {
    std::vector<const Candidate*> others;
    for (const Candidate& candidate : choice.candidates)
        if (text(candidate.setting) != text(choice.setting)) others.push_back(&candidate);
    return others;
}

// A few: what is over the budget though faster, and what comes next.
std::vector<const Candidate*> shown_of(const std::vector<const Candidate*>& others) {
    constexpr std::size_t most = 4;
    std::vector<const Candidate*> over, slower;
    for (const Candidate* other : others) {
        const bool keeps = other->outcome == Outcome::as_fast || other->outcome == Outcome::slower;
        if (other->outcome == Outcome::over_budget && other->error && over.size() < most)
            over.push_back(other);
        else if (keeps && other->fastest_ms && slower.size() < most)
            slower.push_back(other);
    }
    over.insert(over.end(), slower.begin(), slower.end());
    return over;
}

std::string times_text(const Candidate& candidate) {
    if (candidate.times_chosen) return support::fixed(*candidate.times_chosen, 2) + " times";
    return candidate.times_fastest
               ? "about " + support::fixed(*candidate.times_fastest, 2) + " times"
               : "-";
}

// "12 not needed; 31 slower"
std::string outcomes_text(const std::vector<const Candidate*>& candidates) {
    std::vector<std::pair<std::string, int>> counts;
    for (const Candidate* candidate : candidates) {
        const std::string why = reason(*candidate);
        const auto at = std::ranges::find(counts, why, &std::pair<std::string, int>::first);
        if (at != counts.end())
            ++at->second;
        else
            counts.emplace_back(why, 1);
    }
    std::string result;
    for (const auto& [why, count] : counts)
        result += (result.empty() ? "" : "; ") + std::to_string(count) + " " + why;
    return result;
}

void print_others(const Choice& choice, const Budget& budget, std::ostream& out) {
    std::vector<const Candidate*> others = others_of(choice);
    const std::vector<const Candidate*> shown = shown_of(others);
    for (const Candidate* other : shown)
        out << "    " << std::left << std::setw(42) << short_text(other->setting) << std::right
            << std::setw(17) << times_text(*other) << std::setw(12)
            << (other->error ? budget.text_of(*other->error) : "-") << "  " << reason(*other)
            << (other->times ? " (" + quartiles_text(*other->times) + ")" : "") << '\n';
    std::erase_if(others, [&](const Candidate* other) {
        return std::ranges::find(shown, other) != shown.end();
    });
    if (!others.empty())
        out << "    ... and " << others.size() << " more: " << outcomes_text(others)
            << " (--json FILE has all)\n";
}

// ---- how the budget was kept

std::string record_text(const Budget& budget, const BudgetRecord& record) {
    const std::string worst = limit_text(budget.counted(record.worst()), budget);
    return support::grouped(record.checked()) + " of " +
           support::counted(record.frames(), "frame") + " checked, " +
           support::grouped(record.chosen_again()) + " chosen again, " +
           support::grouped(record.over().size()) + " over the budget; the worst " +
           (budget.kind == Budget::Kind::psnr ? "has " : "is off by ") + worst;
}

// Whether it is for the setting, or for what can be proven of any.
std::string not_met_reason(const Choice& choice, const Budget& budget) {
    if (choice.met || budget.met_by(choice.scene.exact))
        return budget.strict && budget.met_by(choice.errors.resolved)
                   ? "--strict counts " +
                         support::counted(choice.errors.undecided_pixels, "undecided pixel")
                   : "no setting meets the budget";
    return (budget.kind == Budget::Kind::psnr ? "no more than " : "no less than ") +
           budget.text_of(choice.scene.exact) +
           " can be proven for any picture of this frame, because floats are rounded; "
           "the picture may be better";
}

std::string not_met_text(const Choice& choice, const Budget& budget, const BudgetRecord& record) {
    std::string text = not_met_reason(choice, budget);
    if (record.over().size() < record.frames())
        text += "; over it in " + support::counted(record.over().size(), "frame") +
                ", first in frame " + support::grouped(record.first_over()) + " of " +
                support::grouped(record.frames());
    return text;
}

nlohmann::ordered_json measured_json(const PictureError& error) {
    nlohmann::ordered_json json{{"largest", error.largest}, {"psnr_db", nullptr}};
    if (std::isfinite(error.psnr_db())) json["psnr_db"] = error.psnr_db();
    return json;
}

nlohmann::ordered_json measured_json(const Spread& times) {
    return {{"ms", times.median_ms},
            {"fastest_ms", times.least_ms},
            {"lower_quartile_ms", times.lower_quartile_ms},
            {"upper_quartile_ms", times.upper_quartile_ms}};
}

}  // namespace

void BudgetRecord::add(const BudgetController::Drawn& drawn, double time, const Budget& budget) {
    ++frames_;
    if (drawn.changed) ++changed_;
    if (drawn.checked) ++checked_;
    if (drawn.chosen_again) ++chosen_again_;
    if (!drawn.errors) return;
    if (!budget.met_by(*drawn.errors)) {
        if (over_.empty()) first_over_ = frames_;
        over_.push_back(time);
    } else if (!budget.met_by(drawn.errors->all)) {
        undecided_pixels_ = std::max(undecided_pixels_, drawn.errors->undecided_pixels);
    }
    if (budget.better(budget.counted(worst_), budget.counted(*drawn.errors)))
        worst_ = *drawn.errors;
}

std::string BudgetRecord::verdict() const {
    if (!met()) return "not met";
    if (undecided_pixels_ == 0) return "met";
    return "met except " + support::counted(undecided_pixels_, "undecided pixel");
}

void print(const Choice& choice, const Budget& budget, const BudgetRecord& record,
           std::ostream& out) {
    const auto line = [&out](const std::string& name, const std::string& what) {
        if (!what.empty())
            out << "  " << std::left << std::setw(18) << name << std::right << what << '\n';
    };
    const SurveyResult& scene = choice.scene;
    const bool is_psnr = budget.kind == Budget::Kind::psnr;
    line("budget", (is_psnr ? "PSNR of at least " : "errors of at most ") + budget.text() +
                       (budget.strict ? ", strict: " : ": ") + record.verdict());
    line("layers", layers_text(scene));
    if (scene.fragments > 0) {
        line("opacity", support::fixed(static_cast<double>(scene.least_alpha), 3) + " to " +
                            support::fixed(static_cast<double>(scene.greatest_alpha), 3));
        line("light that passes", light_text(scene));
        line("order of layers", unresolved_text(scene));
    }
    line(choice.met ? "chosen" : "best setting", chosen_text(choice));
    line("", plainest_text(choice));
    line("error", limit_text(budget.counted(choice.errors), budget) + ", " + basis(choice.bounded));
    if (scene.pixels_unresolved[0] > 0) line("", other_order_text(choice, budget));
    line("speed", speed_text(choice));
    line("search", search_text(choice));
    line("others", std::string(choice.met ? "time relative to the chosen one, and " : "") +
                       (is_psnr ? "PSNR at least" : "error at most"));
    print_others(choice, budget, out);
    if (record.changed() > 0) line("kept", record_text(budget, record));
    if (!record.met()) line("NOT MET", not_met_text(choice, budget, record));
}

nlohmann::ordered_json json_of(const Choice& choice, const Budget& budget,
                               const BudgetRecord& record) {
    constexpr const char* outcomes[] = {"chosen",     "over budget", "as fast",    "slower",
                                        "not needed", "failed",      "not reached"};
    nlohmann::ordered_json json;
    json["budget"] = budget.text();
    json["strict"] = budget.strict;
    json["met"] = record.met();
    json["verdict"] = record.verdict();
    json["undecided_pixels"] = record.undecided_pixels();
    json["setting"] = text(choice.setting);
    json["error"] = measured_json(choice.errors.resolved);
    json["error_with_any_order"] = measured_json(choice.errors.all);
    json["bounded"] = choice.bounded;
    json.update(measured_json(choice.times));
    json["timed_frames"] = choice.timed_frames;
    json["exact_times"] = nullptr;
    if (choice.exact_times) json["exact_times"] = *choice.exact_times;
    json["draws"] = choice.draws;
    json["took_ms"] = choice.took_ms;
    json["not_reached"] = choice.count(Outcome::not_reached);
    json["scene"] = {{"pixels", choice.scene.pixels},
                     {"fragments", choice.scene.fragments},
                     {"nonempty_pixels", choice.scene.nonempty_pixels},
                     {"longest", choice.scene.longest},
                     {"pixels_by_layers", choice.scene.pixels_by_layers},
                     {"least_alpha", choice.scene.least_alpha},
                     {"greatest_alpha", choice.scene.greatest_alpha},
                     {"pixels_unresolved", choice.scene.pixels_unresolved},
                     {"exact", measured_json(choice.scene.exact)}};
    json["candidates"] = nlohmann::ordered_json::array();
    for (const Candidate& candidate : choice.candidates) {
        nlohmann::ordered_json entry{{"setting", text(candidate.setting)},
                                     {"outcome", outcomes[static_cast<int>(candidate.outcome)]}};
        if (candidate.error) entry["error"] = measured_json(*candidate.error);
        if (candidate.fastest_ms) entry["fastest_ms"] = *candidate.fastest_ms;
        if (candidate.times_fastest) entry["times_fastest"] = *candidate.times_fastest;
        if (candidate.times) entry.update(measured_json(*candidate.times));
        if (candidate.times_chosen) entry["times_chosen"] = *candidate.times_chosen;
        if (!candidate.failure.empty()) entry["failure"] = candidate.failure;
        json["candidates"].push_back(entry);
    }
    json["frames"] = {
        {"drawn", record.frames()},    {"changed", record.changed()},
        {"checked", record.checked()}, {"chosen_again", record.chosen_again()},
        {"over_at", record.over()},    {"worst", measured_json(budget.counted(record.worst()))}};
    return json;
}

}  // namespace oit
