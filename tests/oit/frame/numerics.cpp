// SPDX-License-Identifier: MIT
// What docs/numerics.md promises of numbers at their limits holds on the device.
#include "oit/support/numerics.hpp"

#include "oit/support/files.hpp"
#include "support/catch.hpp"
#include "support/device.hpp"
#include "support/errors.hpp"

namespace cellist::test {
namespace {

std::string numerics_document() { return read_file(CELLIST_NUMERICS_DOCUMENT); }

TEST_CASE("colours are within their bounds at the limits of numbers, in every format") {
    const std::string text = numerics_document();
    for (const Extreme& extreme : extremes)
        for (const auto& [format, name] : oit::node_formats) {
            const ColourMetrics metrics = measure(device(), extreme, format);
            INFO(extreme.name << ", " << name << ": " << short_number(metrics.error) << " of "
                              << short_number(metrics.bound) << ", " << metrics.undecided
                              << " pixels undecided");
            CHECK(contains(text, colour_line(extreme, name, metrics)));
            CHECK(metrics.error <= metrics.bound);
            CHECK(metrics.pixels_nan == 0);
            CHECK(metrics.other_counts == 0);
            CHECK(metrics.layers > 0);
            CHECK(metrics.repeats);
            CHECK(metrics.undecided_used <= 1);
        }
}

TEST_CASE("depths from 10^-4 to 10^6 are within their bounds") {
    const std::string text = numerics_document();
    for (const DepthCase& depth_case : depth_cases) {
        const DepthMetrics metrics = measure(device(), depth_case);
        INFO(depth_case.name << ": " << metrics.used << " of the bound");
        CHECK(contains(text, depth_line(depth_case, metrics)));
        CHECK(metrics.fragments > 5000);
        CHECK(metrics.used <= 1);
    }
}

}  // namespace
}  // namespace cellist::test
