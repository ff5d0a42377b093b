// SPDX-License-Identifier: MIT
#include <algorithm>

#include <cellist/report.hpp>

namespace cellist {

Lengths::Lengths(const std::vector<std::uint32_t>& lengths) {
    for (const std::uint32_t length : lengths) {
        ++histogram[length];
        total += length;
        nonempty_cells += length > 0 ? 1 : 0;
        longest = std::max<std::uint64_t>(longest, length);
    }
}

std::string Validation::message() const {
    if (ok()) return "every node is in exactly one list";
    const std::string late =
        std::to_string(late_inserts) + " inserts outside of a build were refused";
    if (broken_links == 0 && repeated_nodes == 0 && lost_nodes == 0) return late;
    std::string text = std::to_string(broken_links) + " broken links, " +
                       std::to_string(repeated_nodes) + " links to nodes in a list already, " +
                       std::to_string(lost_nodes) + " lost nodes";
    if (first_bad_cell)
        text += "; the first bad list is that of cell " + std::to_string(*first_bad_cell);
    if (late_inserts > 0) text += "; " + late;
    return text;
}

}  // namespace cellist
