#pragma once

#include <array>
#include <concepts>
#include <cstddef>

namespace cellist {

/// The work-items of a launch, in 1 to 3 dimensions, x fastest. Exactly these run: no range is
/// rounded up unless padded() says so. A range with an extent of 0 launches nothing.
///
/// Where `local` is 0 the library takes a work-group of up to 256 items that divides the range, and
/// leaves the choice to the driver where none of a useful size does (a prime extent, say). Such
/// ranges are slow on GPUs: pad them.
struct Range {
    std::array<std::size_t, 3> global{1, 1, 1};
    std::array<std::size_t, 3> local{0, 0, 0};
    std::size_t dimensions = 1;

    // An integer is a range: run(1000, ...) reads as it should.
    Range(std::integral auto x)  // NOLINT(google-explicit-constructor)
        : global{static_cast<std::size_t>(x), 1, 1} {}
    Range(std::integral auto x, std::integral auto y)
        : global{static_cast<std::size_t>(x), static_cast<std::size_t>(y), 1}, dimensions(2) {}
    Range(std::integral auto x, std::integral auto y, std::integral auto z)
        : global{static_cast<std::size_t>(x), static_cast<std::size_t>(y),
                 static_cast<std::size_t>(z)},
          dimensions(3) {}

    /// At least `items` work-items, in whole work-groups of `group`. The kernel returns early in
    /// those behind the last item: `if (get_global_id(0) >= count) return;`.
    [[nodiscard]] static Range padded(std::size_t items, std::size_t group = 256) {
        Range range((items + group - 1) / group * group);
        range.local = {group, 1, 1};
        return range;
    }
};

}  // namespace cellist
