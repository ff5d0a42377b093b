// SPDX-License-Identifier: MIT
// Times choose a setting only as far as they tell settings apart; the plainest of the others is
// chosen.
#include "budget/spread.hpp"

#include <string>
#include <tuple>
#include <vector>

#include "methods/method.hpp"
#include "support/catch.hpp"

namespace cellist::test {
namespace {

oit::Setting setting_of(const char* method, const oit::Quality& quality = {}) {
    return {&oit::method_named(method), quality};
}

struct Entry {
    oit::Setting setting;
    std::vector<double> times_ms;
};

std::string chosen(const std::vector<Entry>& entries) {
    std::vector<oit::Timed> timed;
    for (const Entry& entry : entries)
        timed.push_back({entry.setting, oit::spread_of(entry.times_ms)});
    return oit::text(timed[oit::plainest_of_fastest(timed)].setting);
}

TEST_CASE("quartiles have half of the times between them") {
    const oit::Spread spread = oit::spread_of({5, 1, 4, 2, 3});
    CHECK(spread.least_ms == 1);
    CHECK(spread.lower_quartile_ms == 2);
    CHECK(spread.median_ms == 3);
    CHECK(spread.upper_quartile_ms == 4);
    CHECK(oit::spread_of({7}).upper_quartile_ms == 7);
}

TEST_CASE("a setting is measurably slower by its median and by quartiles that do not overlap") {
    const oit::Spread fast{9, 10, 11, 12};
    CHECK(oit::measurably_slower({12, 13, 14, 15}, fast));
    CHECK_FALSE(oit::measurably_slower({9, 11.5, 14, 20}, fast));
    CHECK_FALSE(oit::measurably_slower(fast, {12, 13, 14, 15}));
    // Within 3 %, however little times vary.
    CHECK_FALSE(oit::measurably_slower({10.2, 10.2, 10.2, 10.2}, {10, 10, 10, 10}));
    CHECK(oit::measurably_slower({10.4, 10.4, 10.4, 10.4}, {10, 10, 10, 10}));
}

TEST_CASE("a setting that is clearly faster is chosen, however special it is") {
    CHECK(chosen({{setting_of("linked"), {20, 21, 22}},
                  {setting_of("stochastic", {.size = 4}), {10, 11, 12}},
                  {setting_of("counted"), {15, 16, 17}}}) == "--method stochastic:4");
}

TEST_CASE("on a busy machine the plainest exact setting is chosen, whatever is fastest by chance") {
    const std::vector<double> early{20, 31, 24, 52, 27}, late{22, 35, 21, 48, 29},
        quick{18, 33, 23, 60, 26};
    for (const auto& [a, b, c] : {std::tuple(early, late, quick), std::tuple(late, quick, early),
                                  std::tuple(quick, early, late)}) {
        CHECK(chosen({{setting_of("linked", {.layers = 8}), a},
                      {setting_of("weighted"), b},
                      {setting_of("linked"), c},
                      {setting_of("counted"), a},
                      {setting_of("linked", {.format = oit::NodeFormat::rgba8}), b}}) ==
              "--method linked");
        CHECK(chosen({{setting_of("weighted"), a},
                      {setting_of("counted"), b},
                      {setting_of("peeling"), c}}) == "--method counted");
    }
}

TEST_CASE("the plainest setting does not depend on the order in which settings come") {
    const std::vector<double> times{10, 11, 12};
    CHECK(chosen({{setting_of("counted"), times}, {setting_of("linked"), times}}) ==
          "--method linked");
    CHECK(chosen({{setting_of("linked"), times}, {setting_of("counted"), times}}) ==
          "--method linked");
}

TEST_CASE("exact goes before approximate, all layers before fewer, floats before packed nodes") {
    const std::vector<oit::Setting> order{
        setting_of("linked"),
        setting_of("counted"),
        setting_of("linked", {.format = oit::NodeFormat::rgba16f}),
        setting_of("linked", {.format = oit::NodeFormat::rgb565_d16}),
        setting_of("linked", {.epsilon = 0.003F}),
        setting_of("linked", {.epsilon = 0.1F}),
        setting_of("linked", {.layers = 64}),
        setting_of("linked", {.layers = 8}),
        setting_of("kbuffer", {.size = 16}),
        setting_of("kbuffer", {.size = 8}),
        setting_of("weighted"),
        setting_of("stochastic", {.size = 64}),
        setting_of("stochastic", {.size = 2}),
    };
    for (std::size_t i = 0; i < order.size(); ++i)
        for (std::size_t j = 0; j < order.size(); ++j) {
            INFO(oit::text(order[i]) << " / " << oit::text(order[j]));
            CHECK(oit::plainer(order[i], order[j]) == (i < j));
        }
}

}  // namespace
}  // namespace cellist::test
