#include "choice_report.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <limits>
#include <ostream>
#include <sstream>
#include <string>

#include <nlohmann/json.hpp>

namespace oit {
namespace {

using Fate = Candidate::Fate;

std::string fixed(double value, int decimals) {
    std::ostringstream out;
    out << std::fixed << std::setprecision(decimals) << value;
    return out.str();
}

std::string percent(double part) {
    return fixed(100 * part, 100 * part < 1 && part > 0 ? 3 : 1) + " %";
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
std::uint64_t median_layers(const SceneMeasure& scene) {
    std::uint64_t seen = 0;
    for (std::size_t bin = 1; bin < scene.pixels_by_layers.size(); ++bin) {
        seen += scene.pixels_by_layers[bin];
        if (2 * seen >= scene.nonempty_pixels) return std::min((1UL << bin) - 1, scene.longest);
    }
    return scene.longest;
}

std::string layers_text(const SceneMeasure& scene) {
    if (scene.fragments == 0) return "nothing transparent is to be seen";
    return std::to_string(scene.fragments) + " fragments in " +
           percent(static_cast<double>(scene.nonempty_pixels) / static_cast<double>(scene.pixels)) +
           " of the pixels, half of these with " + std::to_string(median_layers(scene)) +
           " layers at most, the deepest with " + std::to_string(scene.longest);
}

std::string light_text(const SceneMeasure& scene) {
    std::string text;
    for (const SceneMeasure::Cut& cut : scene.cuts)
        if (cut.layers >= 2 && cut.layers < scene.longest)
            text += (text.empty() ? "behind " : ", ") + std::to_string(cut.layers) + " layers " +
                    percent(cut.light_behind);
    return text;
}

std::string untold_text(const SceneMeasure& scene) {
    const auto& [of_float, of_24, of_16] = scene.pixels_untold;
    return "not told by depths of float in " + std::to_string(of_float) +
           " pixels, of 24 bits in " + std::to_string(of_24) + ", of 16 bits in " +
           std::to_string(of_16);
}

std::string reason(const Candidate& candidate) {
    switch (candidate.fate) {
        case Fate::chosen:
            return "chosen";
        case Fate::over_budget:
            return "over the budget";
        case Fate::slower:
            return candidate.fastest_ms ? "slower" : "slower by far, not drawn";
        case Fate::not_needed:
            return "gives up less than needed";
        case Fate::failed:
            return candidate.failure;
    }
    return {};
}

const char* basis(bool bounded) {
    return bounded ? "by its bound"
                   : "compared with all layers in float, that picture's own "
                     "error included";
}

// A few of the others: what is faster and over the budget, and the next.
void print_others(const Choice& choice, const Budget& budget, std::ostream& out) {
    constexpr std::size_t most = 4;
    const auto time = [](const Candidate& candidate) -> std::string {
        if (candidate.times_leader) return fixed(*candidate.times_leader, 2) + " times";
        return candidate.fastest_ms ? fixed(*candidate.fastest_ms, 2) + " ms" : "-";
    };
    const auto row = [&](const Candidate& candidate) {
        out << "    " << std::left << std::setw(44) << short_text(candidate.setting) << std::right
            << std::setw(11) << time(candidate) << std::setw(14)
            << (candidate.error ? budget.text_of(*candidate.error) : "-") << "  "
            << reason(candidate) << '\n';
    };
    std::size_t over = 0, slower = 0;
    for (const Candidate& candidate : choice.candidates)
        if (candidate.fate == Fate::over_budget && candidate.error && ++over <= most)
            row(candidate);
    for (const Candidate& candidate : choice.candidates)
        if (candidate.fate == Fate::slower && candidate.fastest_ms && ++slower <= most)
            row(candidate);
}

nlohmann::ordered_json json_of(const PictureError& error) {
    nlohmann::ordered_json json{{"largest", error.largest}, {"psnr_db", nullptr}};
    if (std::isfinite(error.psnr_db())) json["psnr_db"] = error.psnr_db();
    return json;
}

}  // namespace

void KeptBudget::add(const Keeper::Drawn& drawn, double time, const Budget& budget) {
    ++frames_;
    if (drawn.checked) ++checked_;
    if (drawn.chosen_again) ++chosen_again_;
    if (!drawn.errors) return;
    if (!budget.met_by(drawn.errors->told)) over_.push_back(time);
    if (budget.better(worst_.told, drawn.errors->told)) worst_ = *drawn.errors;
}

void print(const Choice& choice, const Budget& budget, const KeptBudget& kept, std::ostream& out) {
    const auto line = [&out](const std::string& name) -> std::ostream& {
        return out << "  " << std::left << std::setw(18) << name << std::right;
    };
    const SceneMeasure& scene = choice.scene;
    line("budget") << (budget.kind == Budget::Kind::psnr ? "PSNR of at least "
                                                         : "errors of at most ")
                   << budget.text() << '\n';
    line("layers") << layers_text(scene) << '\n';
    if (scene.fragments > 0)
        line("opacity") << fixed(static_cast<double>(scene.least_alpha), 3) << " to "
                        << fixed(static_cast<double>(scene.greatest_alpha), 3) << '\n';
    if (const std::string light = light_text(scene); !light.empty())
        line("light that passes") << light << '\n';
    line("order") << untold_text(scene) << '\n';
    line(choice.met ? "chosen" : "best there is")
        << short_text(choice.setting) << ": " << fixed(choice.fastest_ms, 2) << " ms\n";
    line("error") << budget.text_of(choice.errors.told)
                  << (budget.kind == Budget::Kind::psnr ? " at least, " : " at most, ")
                  << basis(choice.bounded) << '\n';
    if (scene.pixels_untold[0] > 0)
        line("") << "where float does not tell the order, it may be the other: "
                 << budget.text_of(choice.errors.all) << " then\n";
    line("speed") << "all layers in float take " << fixed(choice.exact_ms, 2) << " ms, "
                  << fixed(choice.exact_ms / choice.fastest_ms, 2) << " times as long\n";
    line("others") << choice.candidates.size() << " settings, found with " << choice.draws
                   << " frames in " << fixed(choice.took_ms / 1000, 1) << " s\n";
    print_others(choice, budget, out);
    if (kept.checked() > 0)
        line("kept") << kept.checked() << " of " << kept.frames() << " frames checked, "
                     << kept.chosen_again() << " chosen again, " << kept.over().size()
                     << " over the budget; the worst is off by "
                     << budget.text_of(kept.worst().told) << '\n';
    if (!kept.met())
        line("NOT MET") << "no setting meets the budget"
                        << (kept.frames() > 1 && kept.over().size() < kept.frames()
                                ? " at time " + fixed(kept.over().front(), 3)
                                : std::string())
                        << '\n';
}

nlohmann::ordered_json json_of(const Choice& choice, const Budget& budget, const KeptBudget& kept) {
    constexpr const char* fates[] = {"chosen", "over budget", "slower", "not needed", "failed"};
    nlohmann::ordered_json json;
    json["budget"] = budget.text();
    json["met"] = kept.met();
    json["setting"] = text(choice.setting);
    json["error"] = json_of(choice.errors.told);
    json["error_with_any_order"] = json_of(choice.errors.all);
    json["bounded"] = choice.bounded;
    json["fastest_ms"] = choice.fastest_ms;
    json["exact_ms"] = choice.exact_ms;
    json["draws"] = choice.draws;
    json["took_ms"] = choice.took_ms;
    json["scene"] = {{"pixels", choice.scene.pixels},
                     {"fragments", choice.scene.fragments},
                     {"nonempty_pixels", choice.scene.nonempty_pixels},
                     {"longest", choice.scene.longest},
                     {"pixels_by_layers", choice.scene.pixels_by_layers},
                     {"least_alpha", choice.scene.least_alpha},
                     {"greatest_alpha", choice.scene.greatest_alpha},
                     {"pixels_untold", choice.scene.pixels_untold},
                     {"exact", json_of(choice.scene.exact)}};
    json["candidates"] = nlohmann::ordered_json::array();
    for (const Candidate& candidate : choice.candidates) {
        nlohmann::ordered_json entry{{"setting", text(candidate.setting)},
                                     {"fate", fates[static_cast<int>(candidate.fate)]}};
        if (candidate.error) entry["error"] = json_of(*candidate.error);
        if (candidate.fastest_ms) entry["fastest_ms"] = *candidate.fastest_ms;
        if (candidate.times_leader) entry["times_leader"] = *candidate.times_leader;
        if (!candidate.failure.empty()) entry["failure"] = candidate.failure;
        json["candidates"].push_back(entry);
    }
    json["frames"] = {{"drawn", kept.frames()},
                      {"checked", kept.checked()},
                      {"chosen_again", kept.chosen_again()},
                      {"over_at", kept.over()},
                      {"worst", json_of(kept.worst().told)}};
    return json;
}

}  // namespace oit
