// SPDX-License-Identifier: MIT
// What the screen says of a choice is true of it, and nothing is cut without a word.
#include "report/choice_report.hpp"

#include <sstream>
#include <string>

#include <nlohmann/json.hpp>

#include "oit/support/files.hpp"
#include "report/report.hpp"
#include "support/catch.hpp"
#include "support/errors.hpp"

namespace cellist::test {
namespace {

using Outcome = oit::Candidate::Outcome;

oit::PictureError off_by(double largest) { return {largest, largest * largest}; }

oit::Setting linked(std::optional<std::uint32_t> layers = {}) {
    oit::Setting setting = oit::exact_setting({});
    setting.quality.layers = layers;
    return setting;
}

oit::Setting named(const char* method) {
    oit::Setting setting = linked();
    setting.method = &oit::method_named(method);
    return setting;
}

// Of 8 layers, whose order float does not tell in some pixels.
oit::Choice choice_of(const oit::Setting& setting, std::uint64_t unresolved = 0) {
    oit::Choice choice;
    choice.met = true;
    choice.setting = setting;
    choice.times = {2, 2.1, 2.25, 2.5};
    choice.timed_frames = 15;
    choice.errors = {off_by(0.5 / 255), off_by(unresolved > 0 ? 12.0 / 255 : 0.5 / 255),
                     unresolved};
    choice.scene.pixels = 100;
    choice.scene.fragments = 1234;
    choice.scene.nonempty_pixels = 50;
    choice.scene.longest = 8;
    choice.scene.pixels_by_layers = {50, 25, 25};
    choice.scene.pixels_unresolved = {unresolved, unresolved, 3};
    choice.scene.exact = off_by(0.1 / 255);
    choice.scene.cuts = {{.layers = 2, .error = {}, .light_behind = 0.5},
                         {.layers = 4, .error = {}, .light_behind = 0.25}};
    choice.candidates = {{.setting = setting, .outcome = Outcome::chosen, .times_chosen = 1.0}};
    return choice;
}

oit::Budget budget_of(const char* text) { return oit::parse_budget(text); }

oit::BudgetRecord kept_for(const oit::Choice& choice, const oit::Budget& budget) {
    oit::BudgetRecord record;
    record.add({.checked = true, .errors = choice.errors}, 0, budget);
    return record;
}

std::string screen(const oit::Choice& choice, const oit::Budget& budget) {
    std::ostringstream out;
    oit::print(choice, budget, kept_for(choice, budget), out);
    return out.str();
}

std::string line_with(const std::string& text, const std::string& part) {
    const std::size_t at = text.find(part);
    if (at == std::string::npos) return {};
    const std::size_t before = text.rfind('\n', at);
    const std::size_t first = before == std::string::npos ? 0 : before + 1;
    return text.substr(first, text.find('\n', at) - first);
}

TEST_CASE("speed is relative to all layers in float, and not where these were chosen") {
    oit::Choice choice = choice_of(linked(4));
    choice.exact_times = 1.5;
    CHECK(contains(line_with(screen(choice, budget_of("1/255")), "speed"), "1.50 times"));
    choice = choice_of(linked());
    choice.exact_times = 1;
    CHECK_FALSE(contains(screen(choice, budget_of("1/255")), "speed"));
}

TEST_CASE("a setting that is as fast is not called slower, and one that drew before is marked") {
    oit::Choice choice = choice_of(linked());
    choice.candidates.push_back({.setting = linked(4),
                                 .outcome = Outcome::as_fast,
                                 .fastest_ms = 2,
                                 .times = oit::Spread{1.8, 1.9, 2, 2.2},
                                 .times_chosen = 1.004});
    choice.candidates.push_back(
        {.setting = linked(2), .outcome = Outcome::slower, .fastest_ms = 3, .times_fastest = 1.4});
    const std::string text = screen(choice, budget_of("1/255"));
    const std::string as_fast = line_with(text, "--layers 4"),
                      slower = line_with(text, "--layers 2");
    CHECK(contains(as_fast, " 1.00 times"));
    CHECK(contains(as_fast, "as fast, not as plain (1.90 to 2.20 ms)"));
    CHECK(contains(
        text, "one other setting is as fast, within the spread of the times: the plainest is"));
    CHECK_FALSE(contains(as_fast, "slower"));
    CHECK(contains(slower, "about 1.40 times"));
    CHECK(contains(slower, "slower"));
    const nlohmann::ordered_json json =
        oit::json_of(choice, budget_of("1/255"), kept_for(choice, budget_of("1/255")));
    CHECK(json["candidates"][1]["outcome"] == "as fast");
    CHECK(json["candidates"][1]["lower_quartile_ms"] == 1.9);
    CHECK(json["candidates"][2]["outcome"] == "slower");
}

TEST_CASE("settings that are not shown are counted") {
    oit::Choice choice = choice_of(linked());
    for (std::uint32_t layers = 10; layers < 17; ++layers)
        choice.candidates.push_back(
            {.setting = linked(layers), .outcome = Outcome::slower, .fastest_ms = 3});
    for (std::uint32_t layers = 20; layers < 25; ++layers)
        choice.candidates.push_back(
            {.setting = linked(layers), .outcome = Outcome::over_budget, .error = off_by(0.5)});
    choice.candidates.push_back({.setting = linked(30), .outcome = Outcome::not_needed});
    choice.candidates.push_back({.setting = linked(31), .outcome = Outcome::slower});
    choice.candidates.push_back(
        {.setting = linked(32), .outcome = Outcome::failed, .failure = "why"});
    const std::string rest = line_with(screen(choice, budget_of("1/255")), " more: ");
    for (const char* part : {"... and 7 more", "3 slower", "1 over the budget", "1 not needed",
                             "1 expected to be slower, not drawn", "1 failed", "--json"}) {
        INFO(rest << " / " << part);
        CHECK(contains(rest, part));
    }
}

TEST_CASE("the pixels whose order float does not tell stand beside their error") {
    const std::string line =
        line_with(screen(choice_of(linked(), 1), budget_of("1/255")), "float does");
    CHECK(contains(line, "in 1 undecided pixel float"));
    CHECK(contains(line, "12.00/255 at most, over 1/255 in 1"));
    CHECK(contains(screen(choice_of(linked(), 1200), budget_of("1/255")),
                   "in 1,200 undecided pixels float"));
    CHECK_FALSE(contains(screen(choice_of(linked(), 0), budget_of("1/255")), "the other order"));
}

TEST_CASE("the chosen setting has the spread of its times beside it") {
    const std::string line = line_with(screen(choice_of(linked()), budget_of("1/255")), "chosen  ");
    CHECK(contains(line, "2.25 ms (half of 15 frames in 2.10 to 2.50 ms)"));
    CHECK_FALSE(contains(screen(choice_of(linked()), budget_of("1/255")), "plainest"));
}

TEST_CASE("a budget is met, met except undecided pixels, or not met") {
    const auto verdict_of = [](std::uint64_t unresolved, const char* text, bool strict) {
        oit::Budget budget = budget_of(text);
        budget.strict = strict;
        const oit::Choice choice = choice_of(linked(), unresolved);
        const oit::BudgetRecord record = kept_for(choice, budget);
        const nlohmann::ordered_json json = oit::json_of(choice, budget, record);
        CHECK(json["verdict"] == record.verdict());
        CHECK(json["met"] == record.met());
        CHECK(json["strict"] == strict);
        CHECK(contains(line_with(screen(choice, budget), "budget  "), record.verdict()));
        return record.verdict();
    };
    CHECK(verdict_of(0, "1/255", false) == "met");
    CHECK(verdict_of(0, "1/255", true) == "met");
    CHECK(verdict_of(1, "1/255", false) == "met except 1 undecided pixel");
    CHECK(verdict_of(1200, "40dB", false) == "met except 1,200 undecided pixels");
    CHECK(verdict_of(1, "1/255", true) == "not met");
    CHECK(verdict_of(1, "20/255", true) == "met");
    CHECK(verdict_of(1, "0.2/255", false) == "not met");
}

TEST_CASE("what a search had no time for is counted") {
    oit::Choice choice = choice_of(linked());
    choice.candidates.push_back({.setting = linked(4), .outcome = Outcome::not_reached});
    choice.candidates.push_back({.setting = linked(8), .outcome = Outcome::not_reached});
    CHECK(contains(line_with(screen(choice, budget_of("1/255")), "search"),
                   "the time limit left out 2 settings: raise --search-seconds"));
    CHECK(oit::json_of(choice, budget_of("1/255"), {})["not_reached"] == 2);
}

TEST_CASE("a budget below what can be proven differs from one that no setting meets") {
    oit::Choice choice = choice_of(linked());
    choice.met = false;
    choice.candidates.front().outcome = Outcome::over_budget;
    choice.candidates.front().error = off_by(0.5 / 255);
    choice.candidates.push_back(
        {.setting = named("counted"), .outcome = Outcome::over_budget, .error = off_by(0.5 / 255)});
    std::string text = screen(choice, budget_of("0.05/255"));
    CHECK(contains(line_with(text, "NOT MET"), "no less than 0.1000/255 can be proven"));
    CHECK(count_of(text, "--method linked") == 1);
    CHECK(contains(text, "--method counted"));
    text = screen(choice, budget_of("0.2/255"));
    CHECK(contains(line_with(text, "NOT MET"), "no setting meets the budget"));
    CHECK_FALSE(contains(text, "proven"));
}

TEST_CASE("how a budget was kept is shown where the picture changes, in the budget's terms") {
    const oit::Choice choice = choice_of(linked());
    const auto text_of = [&](const char* text) {
        const oit::Budget budget = budget_of(text);
        oit::BudgetRecord record = kept_for(choice, budget);
        record.add({.changed = true, .checked = true, .errors = choice.errors}, 1, budget);
        record.add({.changed = true}, 2, budget);
        std::ostringstream out;
        oit::print(choice, budget, record, out);
        return line_with(out.str(), "kept");
    };
    CHECK_FALSE(contains(screen(choice, budget_of("1/255")), "kept"));
    CHECK(contains(text_of("1/255"), "2 of 3 frames checked"));
    CHECK(contains(text_of("1/255"), "the worst is off by 0.5000/255 at most"));
    CHECK(contains(text_of("40dB"), "the worst has 54.2 dB at least"));
}

TEST_CASE("the bound of an early end is shown once, and that of the survey where there is one") {
    oit::Report report;
    report.options.quality.epsilon = 0.1F;
    const auto text_of = [&] {
        std::ostringstream out;
        oit::print(report, out);
        return out.str();
    };
    CHECK(contains(text_of(), "early end"));
    report.options.budget = budget_of("1/255");
    report.choice = choice_of(linked());
    CHECK_FALSE(contains(text_of(), "early end"));
}

}  // namespace
}  // namespace cellist::test
