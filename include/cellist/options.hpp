#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include <cellist/struct.hpp>

namespace cellist {

/// What a build does when the pool is full.
enum class Overflow {
    grow,  ///< enlarge the pool to the exact demand and run again
    stop,  ///< throw OverflowError; the lists are empty
    drop,  ///< keep what fits; the report counts what was dropped, and every list is valid
};

/// Which key comes first in a sorted list.
enum class Order { ascending, descending };

/// How the nodes are arranged. Kernels do not change.
enum class Storage {
    /// One pass: a node from the pool, linked to its cell. Reading follows links.
    linked,
    /// Two passes over the same kernel, count and fill. The lists are contiguous: reading is
    /// fast, and the pool holds exactly the records. The kernel must insert as many records into
    /// each cell both times. Processors under PoCL take one pass where they can, with as much
    /// memory again as linked takes.
    counted,
    /// One pass: a number of slots for each cell. For lists that are about equally long.
    fixed,
    /// One of the others. The first blocking builds of a container try them in turn and measure
    /// them; the best is kept from then on. See docs/storages.md.
    automatic,
};

/// The name of a storage, e.g. "linked".
[[nodiscard]] constexpr const char* name_of(Storage storage) {
    switch (storage) {
        case Storage::linked:
            return "linked";
        case Storage::counted:
            return "counted";
        case Storage::fixed:
            return "fixed";
        case Storage::automatic:
            return "automatic";
    }
    return "unknown";
}

namespace detail {

/// What nearest() takes, by name.
struct NearestKey {
    std::string record;
    std::string member;
    std::uint32_t slots = 0;
};

}  // namespace detail

/// The storage of a container: an enumerator of Storage, or nearest(). Converts from and to
/// Storage.
class StorageOption {
public:
    StorageOption(Storage storage) : storage_(storage) {}
    /// Storage::fixed for nearest().
    operator Storage() const { return storage_; }

    /// @private
    explicit StorageOption(detail::NearestKey key)
        : storage_(Storage::fixed), nearest_(std::move(key)) {}
    /// @private
    [[nodiscard]] const std::optional<detail::NearestKey>& nearest_key() const { return nearest_; }

private:
    Storage storage_;
    std::optional<detail::NearestKey> nearest_;
};

/// A number of slots for each cell, in which the records stay that come first by a scalar member,
/// e.g. `nearest(&Hit::depth, 8)`. The report counts the others as dropped. Equal keys are ordered
/// by the remaining members, so the result does not depend on timing. Takes two passes over the
/// same kernel, and two more for each tie-breaking word that is needed. ListsOptions::overflow,
/// capacity_nodes and slots do not apply.
template <class T, class M>
[[nodiscard]] StorageOption nearest(M T::*member, std::uint32_t slots) {
    static_assert(detail::Scalar<M>, "the nearest records are found by a scalar member");
    return StorageOption({DeviceType<T>::name(), detail::member_name(member), slots});
}

struct ListsOptions {
    StorageOption storage = Storage::linked;
    Overflow overflow = Overflow::grow;
    /// Nodes in the pool at first. Without it the pool starts at one node a cell, at least 65,536,
    /// under Overflow::grow; the other policies need it. Storage::fixed has no use for it.
    std::optional<std::uint64_t> capacity_nodes = {};
    /// Slots for each cell in Storage::fixed at first: 4 under Overflow::grow, which raises it to
    /// the longest list; the other policies need it.
    std::optional<std::uint32_t> slots = {};
    /// The most device memory that the container keeps: heads, nodes, counters, and the buffers that
    /// sorts, downloads and builds keep for reuse. See Lists::pool_bytes().
    std::uint64_t budget_bytes = std::numeric_limits<std::uint64_t>::max();
    /// For Storage::automatic: how often kernels read all lists after each build.
    std::uint32_t expected_reads = 1;
};

}  // namespace cellist
