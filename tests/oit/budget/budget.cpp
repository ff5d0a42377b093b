// SPDX-License-Identifier: MIT
// A budget is met against the reference in double precision, again after the view has changed, and
// where no setting meets it, that is said.
#include "budget/budget.hpp"

#include <initializer_list>
#include <string>

#include "budget/budget_controller.hpp"
#include "camera.hpp"
#include "input_error.hpp"
#include "oit/support/random_scene.hpp"
#include "reference/comparison.hpp"
#include "reference/reference.hpp"
#include "scene/scenes.hpp"
#include "support/catch.hpp"
#include "support/device.hpp"

namespace cellist::test {
namespace {

using Outcome = oit::Candidate::Outcome;

raster::View view_from(double azimuth_degrees) {
    return support::frame_unit_sphere({azimuth_degrees, 10}, 48, 36);
}

void require_met(const oit::Frame& frame, const oit::BudgetController& controller,
                 const oit::Budget& budget) {
    const oit::Comparison comparison =
        oit::compare(oit::draw_reference(frame, {}), controller.renderer().image(), {});
    INFO(oit::text(controller.choice().setting)
         << ": " << comparison.psnr_db << " dB, largest error " << comparison.max_abs_error);
    if (comparison.pixels_ambiguous > 0) return;  // either order is right there
    if (budget.kind == oit::Budget::Kind::psnr)
        CHECK(comparison.psnr_db >= budget.limit);
    else
        CHECK(comparison.max_abs_error <= budget.limit);
}

// All layers in float have drawn interleaved with what was chosen, or are what was chosen.
void require_times_against_chosen(const oit::Choice& choice) {
    const std::string exact = oit::text(oit::exact_setting(choice.setting.quality));
    for (const oit::Candidate& candidate : choice.candidates) {
        INFO(oit::text(candidate.setting));
        if (candidate.outcome == Outcome::chosen) CHECK(candidate.times_chosen == 1.0);
        if (oit::text(candidate.setting) == exact)
            CHECK(candidate.times_chosen == choice.exact_times);
        if (candidate.outcome == Outcome::slower && candidate.fastest_ms)
            CHECK((candidate.times_chosen || candidate.times_fastest));
    }
    CHECK(choice.exact_times.has_value());
    if (oit::text(choice.setting) == exact) CHECK(choice.exact_times == 1.0);
}

}  // namespace

TEST_CASE("a budget is decibels, a fraction or a number") {
    CHECK(oit::parse_budget("40dB").kind == oit::Budget::Kind::psnr);
    CHECK(oit::parse_budget("40dB").limit == 40);
    for (const char* text : {"40db", "40DB", "40 dB", "40  db"}) {
        INFO(text);
        CHECK(oit::parse_budget(text).limit == 40);
        CHECK(oit::parse_budget(text).kind == oit::Budget::Kind::psnr);
    }
    CHECK(oit::parse_budget("1/255").kind == oit::Budget::Kind::largest);
    CHECK(oit::parse_budget("1/255").limit == 1.0 / 255);
    CHECK(oit::parse_budget("0.004").limit == 0.004);
    for (const char* text :
         {"", "dB", "-1dB", "0dB", "nandB", "infdB", "1000dB", "1/0", "0/255", "256/255", "-0.1",
          "0", "1", "1e400", "nan", "0.1x", "1/2/3", "40 dBx"}) {
        INFO(text);
        CHECK_THROWS_AS(oit::parse_budget(text), support::InputError);
    }
}

TEST_CASE("a search reports its progress, from 0 to 1") {
    const oit::Scene scene = random_scene(1, {oit::Blend::over});
    const oit::Frame frame{.scene = scene, .views = {view_from(30)}};
    std::vector<double> parts;
    const oit::BudgetController controller(
        device(), frame, oit::parse_budget("35dB"), 1,
        {.progress = [&](double part) { parts.push_back(part); }, .seconds = 0});
    REQUIRE(parts.size() > 2);
    CHECK(parts.front() == 0);
    CHECK(parts.back() == 1);
    CHECK(std::ranges::is_sorted(parts));
}

TEST_CASE("what is chosen meets the budget, also after the view has changed") {
    const oit::Scene scene = random_scene(1, {oit::Blend::over});
    for (const char* text : {"35dB", "1/255"}) {
        const oit::Budget budget = oit::parse_budget(text);
        oit::Frame frame{.scene = scene, .views = {view_from(30)}};
        oit::BudgetController controller(device(), frame, budget);
        INFO("budget " << text);
        REQUIRE(controller.choice().met);
        const oit::BudgetController::Drawn first = controller.draw();
        CHECK(first.checked);
        CHECK_FALSE(first.changed);
        CHECK_FALSE(controller.draw().checked);
        require_met(frame, controller, budget);
        for (const double azimuth : {75.0, 200.0}) {
            frame.views = {view_from(azimuth)};
            const oit::BudgetController::Drawn drawn = controller.draw();
            CHECK(drawn.changed);
            CHECK(drawn.checked);
            REQUIRE(budget.met_by(drawn.errors.value().resolved));
            require_met(frame, controller, budget);
        }
    }
}

TEST_CASE("times are relative to what was chosen, and settings as fast are not as plain") {
    const oit::Scene scene = random_scene(3, {oit::Blend::over});
    const oit::Frame frame{.scene = scene, .views = {view_from(30)}};
    for (const char* text : {"25dB", "1/255"}) {
        const oit::Budget budget = oit::parse_budget(text);
        const oit::Choice choice = oit::BudgetController(device(), frame, budget).choice();
        require_times_against_chosen(choice);
        for (const oit::Candidate& candidate : choice.candidates) {
            if (candidate.outcome != Outcome::as_fast) continue;
            INFO(oit::text(candidate.setting));
            CHECK(candidate.times.has_value());
            CHECK(plainer(choice.setting, candidate.setting));
        }
    }
}

TEST_CASE("a search that has no time chooses from what it has seen, and says what it has not") {
    const oit::Scene scene = random_scene(3, {oit::Blend::over});
    const oit::Frame frame{.scene = scene, .views = {view_from(30)}};
    const oit::Choice choice =
        oit::BudgetController(device(), frame, oit::parse_budget("25dB"), 1, {.seconds = 0})
            .choice();
    CHECK(choice.met);
    CHECK(oit::text(choice.setting) == oit::text(oit::exact_setting({})));
    CHECK(choice.timed_frames >= 3);
    CHECK(choice.count(Outcome::not_reached) > 10);
    for (const oit::Candidate& candidate : choice.candidates)
        if (candidate.outcome == Outcome::not_reached)
            CHECK_FALSE(candidate.fastest_ms.has_value());
}

TEST_CASE("undecided pixels keep a frame from a strict budget, and are counted for any other") {
    const oit::Scene scene = oit::find_scene("extreme-coplanar")->make(0.5F);
    const oit::Frame frame{.scene = scene, .views = {support::frame_unit_sphere({0, 0}, 48, 36)}};
    for (const char* text : {"1/255", "40dB"}) {
        INFO(text);
        oit::Budget budget = oit::parse_budget(text);
        const oit::Choice choice =
            oit::BudgetController(device(), frame, budget, 1, {.seconds = 0}).choice();
        CHECK(choice.met);
        CHECK(choice.errors.undecided_pixels > 0);
        CHECK(choice.errors.undecided_pixels <= choice.scene.pixels_unresolved[0]);
        CHECK_FALSE(budget.met_by(choice.errors.all));
        budget.strict = true;
        const oit::Choice strict =
            oit::BudgetController(device(), frame, budget, 1, {.seconds = 0}).choice();
        CHECK_FALSE(strict.met);
        CHECK_FALSE(budget.met_by(strict.errors));
    }
}

TEST_CASE("a budget that no setting meets leads to the most accurate one") {
    const oit::Scene scene = random_scene(2, {oit::Blend::over});
    const oit::Frame frame{.scene = scene, .views = {view_from(30)}};
    const oit::BudgetController controller(device(), frame, oit::parse_budget("199dB"));
    CHECK_FALSE(controller.choice().met);
    CHECK_FALSE(oit::parse_budget("199dB").met_by(controller.choice().scene.exact));
    for (const oit::Candidate& candidate : controller.choice().candidates)
        if (candidate.error)
            CHECK(candidate.error->psnr_db() <= controller.choice().errors.resolved.psnr_db());
}

}  // namespace cellist::test
