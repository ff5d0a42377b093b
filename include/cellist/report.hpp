// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <cellist/detail/api.hpp>

namespace cellist {

/// The result of a build or an append. `existing + attempted == stored + dropped + rejected` holds
/// exactly.
struct BuildReport {
    std::uint64_t attempted = 0;       ///< inserts that the kernels called in the last pass
    std::uint64_t stored = 0;          ///< records in the lists now, existing ones included
    std::uint64_t dropped = 0;         ///< no node was free, or nearest() kept others
    std::uint64_t rejected = 0;        ///< records for cells outside the shape
    std::uint64_t capacity_nodes = 0;  ///< nodes in the pool after the build
    /// How often the kernels ran: 1 in Storage::linked and Storage::fixed; 2 in Storage::counted,
    /// or 1 in a single pass; at least 2 in a storage of nearest(). Growing and slices add more.
    std::uint32_t passes = 0;
    std::uint64_t existing = 0;  ///< records in the lists before an append; 0 for a build
};

/// The cells that have lists during one callback of build_slices: first_cell ... first_cell + cells
/// - 1.
struct Slice {
    std::uint64_t first_cell;
    std::uint64_t cells;
};

/// The lengths of the lists.
struct CELLIST_API Lengths {
    Lengths() = default;
    /// Summarises lists of these lengths.
    explicit Lengths(const std::vector<std::uint32_t>& lengths);

    /// The number of cells by the length of their list. A length that no list has is not an entry.
    std::map<std::uint64_t, std::uint64_t> histogram;
    std::uint64_t longest = 0;         ///< nodes in the longest list
    std::uint64_t nonempty_cells = 0;  ///< cells with at least one node
    std::uint64_t total = 0;           ///< nodes in all lists
};

/// The result of Lists::validate(). All counts are 0 in a sound container.
struct CELLIST_API Validation {
    std::uint64_t broken_links = 0;    ///< links, offsets or counts that lead outside the lists
    std::uint64_t repeated_nodes = 0;  ///< links to a node that is already in a list, or in circles
    std::uint64_t lost_nodes = 0;      ///< nodes that no list reaches, or that were never written
    std::uint64_t late_inserts = 0;    ///< refused inserts since the last build or append
    /// The lowest cell with one of these faults. Empty without faults, and if only sums differ.
    std::optional<std::uint64_t> first_bad_cell;

    /// True if every stored node is in exactly one list, once, and no insert was outside a build.
    [[nodiscard]] bool ok() const {
        return broken_links == 0 && repeated_nodes == 0 && lost_nodes == 0 && late_inserts == 0;
    }
    /// Returns one readable line.
    [[nodiscard]] std::string message() const;
};

}  // namespace cellist
