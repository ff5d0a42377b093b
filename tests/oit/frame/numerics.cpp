// What docs/numerics.md promises of numbers at their limits holds on the device.
#include "oit/support/numerics.hpp"

#include "oit/support/files.hpp"
#include "support/catch.hpp"
#include "support/device.hpp"
#include "support/errors.hpp"

namespace cellist::test {
namespace {

std::string document() { return read_file(CELLIST_NUMERICS_DOCUMENT); }

TEST_CASE("colours are within their bounds at the limits of numbers, in every format") {
    const std::string text = document();
    for (const Extreme& extreme : extremes)
        for (const auto& [format, name] : oit::node_formats) {
            const ColourFigures figures = measure(device(), extreme, format);
            INFO(extreme.name << ", " << name << ": " << figure(figures.error) << " of "
                              << figure(figures.bound) << ", " << figures.undecided
                              << " pixels undecided");
            CHECK(contains(text, colour_line(extreme, name, figures)));
            CHECK(figures.error <= figures.bound);
            CHECK(figures.pixels_nan == 0);
            CHECK(figures.other_counts == 0);
            CHECK(figures.layers > 0);
            CHECK(figures.repeats);
            CHECK(figures.undecided_used <= 1);
        }
}

TEST_CASE("depths from 10^-4 to 10^6 are within their bounds") {
    const std::string text = document();
    for (const DepthCase& depth_case : depth_cases) {
        const DepthFigures figures = measure(device(), depth_case);
        INFO(depth_case.name << ": " << figures.used << " of the bound");
        CHECK(contains(text, depth_line(depth_case, figures)));
        CHECK(figures.fragments > 5000);
        CHECK(figures.used <= 1);
    }
}

}  // namespace
}  // namespace cellist::test
