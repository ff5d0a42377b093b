// SPDX-License-Identifier: MIT
// Pixels count as self-shadowed where they are darker than the reference allows by chance.
#include "self_shadow.hpp"

#include <cmath>
#include <vector>

#include "support/catch.hpp"

namespace cellist::test {
namespace {

bool is_near(double a, double b) { return std::abs(a - b) <= 1e-9 * std::abs(b) + 1e-15; }

TEST_CASE("Wilson's interval has the ends of its quadratic equation") {
    for (const double trials : {8.0, 305.0, 3000.0})
        for (const double part : {0.0, 0.01, 0.5, 1.0}) {
            const double share = std::round(part * trials) / trials;
            const double upper = motion::wilson_upper(share * trials, trials, 4);
            CHECK(upper >= share - 1e-12);
            // (p - u)^2 = z^2 u (1 - u) / n
            CHECK(is_near((share - upper) * (share - upper), 16 * upper * (1 - upper) / trials));
        }
    CHECK(is_near(motion::wilson_upper(0, 3000, 4), 16.0 / 3016));
}

TEST_CASE("the tail of a binomial distribution is the sum of its terms") {
    for (const int n : {1, 8, 20, 64})
        for (const double p : {1e-6, 0.005, 0.3, 0.97})
            for (int d = 0; d <= n; ++d) {
                double sum = 0;
                for (int k = n; k >= d; --k) {
                    double term = std::pow(1 - p, n - k);
                    for (int i = 0; i < k; ++i) term *= p * (n - i) / (k - i);
                    sum += term;
                }
                CHECK(is_near(
                    motion::binomial_tail(static_cast<unsigned>(d), static_cast<unsigned>(n), p),
                    sum));
            }
    CHECK(motion::binomial_tail(9, 8, 0.5) == 0);
    CHECK(motion::binomial_tail(0, 0, 0.5) == 1);
    CHECK(motion::binomial_tail(5'000, 10'000, 0.01) < 1e-300);
    CHECK(motion::binomial_tail(50, 10'000, 0.01) > 0.999);
}

TEST_CASE("three dark samples of 8 are too many where the reference is lit, and two are not") {
    const auto count = [](double dark_samples, std::uint32_t samples, double dark_moments,
                          std::uint32_t moments) {
        const std::vector<cl_float4> picture{
            {{1, 1, 1, static_cast<float>(dark_samples / samples)}}};
        const std::vector<cl_float4> reference{
            {{1, 1, 1, static_cast<float>(dark_moments / moments)}}};
        return motion::self_shadowing(picture, samples, reference, moments);
    };
    CHECK(count(2, 8, 0, 3000).self_shadowed == 0);
    CHECK(count(3, 8, 0, 3000).self_shadowed == 1);
    CHECK(count(3, 20, 0, 3000).self_shadowed == 0);
    CHECK(count(4, 20, 0, 3000).self_shadowed == 1);
    CHECK(count(20, 20, 0, 3000).lit == 1);
    // A part of the pixel is in shadow.
    CHECK(count(20, 20, 300, 3000).lit == 0);
    CHECK(count(20, 20, 300, 3000).self_shadowed == 0);
    // Too few moments to be sure.
    CHECK(count(20, 20, 0, 304).lit == 0);
    CHECK(count(20, 20, 0, 305).lit == 1);
    // All samples may be needed.
    CHECK(count(1, 1, 0, 3000).self_shadowed == 0);
}

}  // namespace
}  // namespace cellist::test
