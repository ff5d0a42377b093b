#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace cellist {

/// What a build did. `attempted == stored + dropped + rejected`, exactly.
struct BuildReport {
    std::uint64_t attempted = 0;       ///< inserts that the kernels called in the last pass
    std::uint64_t stored = 0;          ///< records in the lists
    std::uint64_t dropped = 0;         ///< records that found no free node
    std::uint64_t rejected = 0;        ///< records for cells outside of the shape
    std::uint64_t capacity_nodes = 0;  ///< nodes in the pool after the build
    std::uint32_t passes = 0;          ///< times the kernels ran: 1, or 2 in Storage::counted, and
                                       ///< more after growing
};

/// The cells that have lists while a build in slices reads them: `cells` of them from first_cell
/// on.
struct Slice {
    std::uint64_t first_cell;
    std::uint64_t cells;
};

/// How long the lists are.
struct Lengths {
    Lengths() = default;
    /// Of lists with these lengths.
    explicit Lengths(const std::vector<std::uint32_t>& lengths);

    /// Cells by the length of their list; no entry where no list has a length.
    std::map<std::uint64_t, std::uint64_t> histogram;
    std::uint64_t longest = 0;         ///< nodes in the longest list
    std::uint64_t nonempty_cells = 0;  ///< cells with at least one node
    std::uint64_t total = 0;           ///< nodes in all lists
};

/// What Lists::validate() found. All counts are 0 in a sound container.
struct Validation {
    std::uint64_t broken_links = 0;    ///< links, offsets or counts that lead outside of the lists
    std::uint64_t repeated_nodes = 0;  ///< links to a node that is in a list already: cycles, too
    std::uint64_t lost_nodes = 0;      ///< nodes that no list leads to, or that were never written
    std::uint64_t late_inserts = 0;    ///< inserts since the last build, which were refused
    /// Lowest cell that shows one of these. None where all is well, or where only sums differ.
    std::optional<std::uint64_t> first_bad_cell;

    /// True if every stored node is in exactly one list, exactly once, and every insert was in a
    /// build.
    [[nodiscard]] bool ok() const {
        return broken_links == 0 && repeated_nodes == 0 && lost_nodes == 0 && late_inserts == 0;
    }
    /// One line for people.
    [[nodiscard]] std::string message() const;
};

}  // namespace cellist
