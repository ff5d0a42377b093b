// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>

#include <cellist/struct.hpp>

namespace cellist {

/// The overflow policy: what a build does when the pool is full.
enum class Overflow {
    grow,  ///< enlarge the pool to the exact demand and run again
    stop,  ///< throw OverflowError; the lists are empty
    drop,  ///< keep what fits; the report counts what was dropped, and every list is valid
};

/// Which key comes first in a sorted list.
enum class Order { ascending, descending };

/// The arrangement of the nodes. Kernels do not change with it.
enum class Storage {
    /// One pass: takes a node from the pool and links it to its cell. Reading follows links.
    linked,
    /// Two passes over the same kernel, which count and fill. The lists are contiguous, so reading
    /// is fast, and the pool holds exactly the records. The kernel must insert the same number of
    /// records into each cell both times. On GPUs and on processors under PoCL, builds take one
    /// pass if they can, and about as much additional memory as Storage::linked.
    counted,
    /// One pass into a fixed number of slots per cell. For lists of about equal length.
    fixed,
    /// One of the others. The first blocking builds of a container measure them in turn; the
    /// fastest then stays in use. See docs/storages.md.
    automatic,
};

/// Every storage but Storage::automatic.
inline constexpr std::array all_storages{Storage::linked, Storage::counted, Storage::fixed};

/// Returns the name of a storage, e.g. "linked".
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

/// The arguments of nearest(), by name.
struct NearestKey {
    const char* record = nullptr;
    const char* member = nullptr;
    std::uint32_t slots = 0;
};

}  // namespace detail

/// The storage of a container: an enumerator of Storage, or the result of nearest(). Converts from
/// and to Storage.
class StorageOption {
public:
    StorageOption(Storage storage) : storage_(storage) {}
    /// Returns Storage::fixed for nearest().
    operator Storage() const { return storage_; }

    /// @private
    explicit StorageOption(const detail::NearestKey& key)
        : storage_(Storage::fixed), nearest_(key) {}
    /// @private Null unless the storage is that of nearest().
    [[nodiscard]] const detail::NearestKey* nearest_key() const {
        return nearest_.member == nullptr ? nullptr : &nearest_;
    }

private:
    Storage storage_;
    // Of trivial types: g++ 12 warns of a destructor where users put options into a static vector.
    detail::NearestKey nearest_;
};

/// Returns a storage with a fixed number of slots per cell, which keeps the records that come first
/// by a scalar member, e.g. `nearest(&Hit::depth, 8)`. The report counts the others as dropped. The
/// remaining members order equal keys, so the result does not depend on timing. The kernels run
/// twice, and twice more for each further word that decides ties. ListsOptions::overflow,
/// capacity_nodes and slots do not apply. The constructor of Lists throws Error if the lists have
/// another record.
template <class T, class M>
[[nodiscard]] StorageOption nearest(M T::*member, std::uint32_t slots) {
    static_assert(detail::Scalar<M>, "the nearest records are found by a scalar member");
    return StorageOption({detail::description<T>.name, detail::member_name(member), slots});
}
/// The same for records that are scalars, e.g. `nearest<cl_float>(8)`.
template <detail::Scalar T>
[[nodiscard]] StorageOption nearest(std::uint32_t slots) {
    return StorageOption({detail::scalar_name<T>(), "", slots});
}

/// The options of a container. The defaults are linked lists in a pool that grows.
struct ListsOptions {
    StorageOption storage = Storage::linked;
    Overflow overflow = Overflow::grow;
    /// Nodes in the pool at first. The default under Overflow::grow is one node per cell, and at
    /// least 65,536; the other policies need a value. Has no effect in Storage::fixed.
    std::optional<std::uint64_t> capacity_nodes = {};
    /// Slots per cell in Storage::fixed at first. The default under Overflow::grow is 4, which
    /// grows to the longest list; the other policies need a value.
    std::optional<std::uint32_t> slots = {};
    /// Bounds all device memory that the container keeps: heads, nodes, counters, and the buffers
    /// for reuse by sorts, downloads and builds. See Lists::pool_bytes().
    std::uint64_t budget_bytes = std::numeric_limits<std::uint64_t>::max();
    /// For Storage::automatic: how often kernels read all lists after each build.
    std::uint32_t expected_reads = 1;
    /// The axes that wrap around: on a periodic axis, the cells at both ends are neighbours, and a
    /// coordinate outside the shape wraps around to a cell inside. On the other axes, nothing
    /// lies beyond the shape. E.g. `.periodic = {true, true, false}`.
    std::array<bool, 4> periodic = {};
};

}  // namespace cellist
