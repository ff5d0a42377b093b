// SPDX-License-Identifier: MIT
#include "closest.hpp"

#include <algorithm>
#include <vector>

namespace support {
namespace {

// The distance of two texts by optimal string alignment: the number of characters that are
// inserted, left out, changed, or swapped with the next.
std::size_t distance(std::string_view a, std::string_view b) {
    const std::size_t width = b.size() + 1;
    std::vector<std::size_t> steps((a.size() + 1) * width);
    const auto at = [&](std::size_t i, std::size_t j) -> std::size_t& {
        return steps[i * width + j];
    };
    for (std::size_t i = 0; i <= a.size(); ++i) at(i, 0) = i;
    for (std::size_t j = 0; j <= b.size(); ++j) at(0, j) = j;
    for (std::size_t i = 1; i <= a.size(); ++i)
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t change = a[i - 1] == b[j - 1] ? 0 : 1;
            at(i, j) = std::min({at(i - 1, j) + 1, at(i, j - 1) + 1, at(i - 1, j - 1) + change});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                at(i, j) = std::min(at(i, j), at(i - 2, j - 2) + 1);
        }
    return steps.back();
}

}  // namespace

std::string did_you_mean(std::string_view text, std::span<const std::string> names) {
    constexpr std::size_t longest = 100;  // no name is as long
    if (text.size() > longest) return {};
    std::size_t least = std::max<std::size_t>(text.size(), 3) / 3 + 1;
    std::string_view closest;
    for (const std::string& name : names)
        if (const std::size_t steps = distance(text, name); steps < least) {
            least = steps;
            closest = name;
        }
    return closest.empty() ? "" : " (did you mean '" + std::string(closest) + "'?)";
}

}  // namespace support
