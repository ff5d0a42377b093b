#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include <cellist/cellist.hpp>

#include "fragment_source.hpp"

namespace oit {

/// How lists keep under Frame::memory_bytes: the pixels are taken in slices, and the lists of each are
/// built, blended and forgotten (cellist::Lists::build_slices).
struct Slices {
    std::uint64_t budget_bytes = 0;  ///< for everything
    std::uint64_t head_bytes = 0;    ///< of all pixels, whatever the lists hold
    std::uint64_t count_bytes = 0;   ///< of the counts by which slices are chosen
    std::uint64_t node_bytes = 0;
    std::uint32_t count = 0;  ///< of the last frame
};

/// What lists of a frame take; nothing where its memory is not bounded, or where the lists' own bound is
/// not to be passed.
template <class Node>
std::optional<Slices> slice_plan(const FragmentSource& source,
                                 const cellist::ListsOptions& options) {
    const std::optional<std::uint64_t> budget = source.frame().memory_bytes;
    if (!budget || options.overflow != cellist::Overflow::grow) return {};
    const auto bytes_of_empty = [&](const cellist::ListsOptions& empty) {
        return cellist::Lists<Node>(source.device(), source.shape(), empty).pool_bytes();
    };
    const bool linked = options.storage == cellist::Storage::linked;
    return Slices{
        .budget_bytes = *budget,
        .head_bytes = bytes_of_empty({.storage = options.storage, .capacity_nodes = 0, .slots = 0}),
        .count_bytes = bytes_of_empty({.storage = cellist::Storage::counted,
                                       .overflow = cellist::Overflow::drop,
                                       .capacity_nodes = 0}),
        .node_bytes = sizeof(Node) + (linked ? sizeof(cl_uint) : 0)};
}

/// The options of lists under such a plan.
[[nodiscard]] cellist::ListsOptions sliced(cellist::ListsOptions options,
                                           const std::optional<Slices>& slices);

/// Throws InputError, which says what would be enough: heads, counts, and the longest list. Blocks.
[[noreturn]] void refuse_budget(FragmentSource& source, const Slices& slices);

/// Builds lists a slice at a time, and blends each. Throws InputError where the budget is too small.
/// Blocks.
template <class Node>
void build_in_slices(FragmentSource& source, Slices& slices, cellist::Lists<Node>& lists,
                     const std::function<void()>& insert, const std::function<void()>& blend) {
    slices.count = 0;
    if (slices.budget_bytes < slices.head_bytes + slices.count_bytes) refuse_budget(source, slices);
    try {
        lists.build_slices(insert, [&](const cellist::Slice& slice) {
            source.set_slice(slice);
            blend();
            ++slices.count;
        });
    } catch (const cellist::OverflowError&) {
        refuse_budget(source, slices);
    }
}

}  // namespace oit
