#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <cellist/detail/lists_core.hpp>
#include <cellist/device.hpp>
#include <cellist/host_lists.hpp>
#include <cellist/kernel.hpp>
#include <cellist/options.hpp>
#include <cellist/report.hpp>
#include <cellist/shape.hpp>
#include <cellist/struct.hpp>

namespace cellist {

/// The lists of all cells in device memory, one behind the other: the records of cell c are
/// records[offsets[c]] ... records[offsets[c + 1] - 1].
template <class T>
struct Packed {
    Buffer<cl_uint> offsets;  ///< cells + 1
    Buffer<T> records;
};

/// A list of records T for each cell of a shape, in device memory.
///
/// Kernels fill the lists concurrently, with cellist_insert; see kernels/cellist/lists.clh for what
/// they can do. The heads take 4 bytes a cell, and a node takes the record and 4 bytes, rounded up to
/// the alignment of both.
///
/// Owned by value, movable, not copyable. What runs on the device is enqueued on the device's queue;
/// calls that return results block until they have them, the others do not.
template <class T>
class Lists {
    static_assert(detail::Adapted<T>, "adapt the record with CELLIST_STRUCT first");

public:
    /// Empty lists. Throws Error if the shape or the capacity exceeds a limit of the device or of
    /// the budget.
    Lists(const Device& device, const Shape& shape, const ListsOptions& options = {})
        : core_(device.state(), detail::definitions_of<T>(), shape, options) {}

    /// Fills the lists anew: clears them, then runs `kernel(lists, args...)` over `range`. The lists
    /// are the kernel's first parameters; `args` are the rest.
    ///
    /// If the pool is too small, the overflow policy decides: grow enlarges it to the exact demand
    /// and runs the kernel again, which must insert the same records again; stop and a demand over
    /// the budget or the device's limit throw OverflowError; drop keeps what fits. After an exception
    /// the lists are empty. Blocks until the report is there.
    template <class... Args>
    BuildReport build(Kernel& kernel, const Range& range, const Args&... args) {
        return build([&] { kernel.run(range, *this, args...); });
    }

    /// The same for several inserting kernels: `insert` enqueues all of them with Kernel::run, and is
    /// called again after the pool has grown.
    BuildReport build(std::invocable auto&& insert) {
        detail::ListsCore* core = &core_;
        return detail::ListsCore::build({&core, 1}, insert).front();
    }

    /// Empties the lists; the pool keeps its capacity. Does not block.
    void clear() { core_.clear(); }

    /// Sorts every list by a scalar member: cellist_for_each then visits the least first, or the
    /// greatest. Records with equal keys are ordered by their remaining members, ascending, in order
    /// of declaration, so
    /// the result depends on the records alone and not on the order of insertion. Floats are ordered
    /// -inf < ... < -0 < +0 < ... < +inf < NaN. Lists have any length. The
    /// first call for a member compiles a kernel; does not block otherwise.
    template <class M>
    cl::Event sort(M T::*member, Order order = Order::ascending) {
        return core_.sort("record." + detail::member_name(member), order);
    }

    /// The same by an OpenCL C expression of `record`, of integer or float type, such as
    /// "record.x * record.x + record.y * record.y". Throws OpenClError where it does not compile, and
    /// Error where it is not one expression of up to 1024 characters: comments, braces, statements,
    /// text and directives are refused. Its value must be defined: after a division by 0 the order is
    /// not, and records may be lost.
    cl::Event sort_by(const std::string& expression, Order order = Order::ascending) {
        return core_.sort(expression, order);
    }

    /// How long the lists are. Blocks.
    [[nodiscard]] Lengths lengths() const { return core_.lengths(); }

    /// A copy of all lists in host memory. Blocks.
    [[nodiscard]] HostLists<T> download() const {
        std::vector<T> records;
        auto offsets = core_.download([&records](std::uint64_t count) -> void* {
            records.resize(count);
            return records.data();
        });
        return {shape(), std::move(offsets), std::move(records)};
    }

    /// A copy of all lists in device memory, one behind the other, for kernels that leave the
    /// container. Blocks until it knows the size.
    [[nodiscard]] Packed<T> pack() const {
        Packed<T> packed{{core_.device(), shape().cells() + 1}, {core_.device(), 0}};
        core_.pack(packed.offsets.cl(), [&](std::uint64_t count) {
            packed.records = Buffer<T>(core_.device(), count);
            return packed.records.cl();
        });
        return packed;
    }

    /// Checks that every allocated node is reached from exactly one head, exactly once. Finds any
    /// corruption of heads and links in time proportional to cells + nodes. Takes one bit of device
    /// memory a node. Sums are compared with those of the last build; inserts outside of one are
    /// counted. Blocks.
    [[nodiscard]] Validation validate() const { return core_.validate(); }

    [[nodiscard]] const Shape& shape() const { return core_.shape(); }
    /// Nodes in the pool.
    [[nodiscard]] std::uint64_t capacity_nodes() const { return core_.capacity_nodes(); }
    /// Device memory of heads, nodes and counters.
    [[nodiscard]] std::uint64_t pool_bytes() const { return core_.pool_bytes(); }

    /// @private
    [[nodiscard]] const detail::ListsCore& core() const { return core_; }
    /// @private
    [[nodiscard]] detail::ListsCore& core() { return core_; }

private:
    detail::ListsCore core_;
};

/// Fills several containers at once: `insert` enqueues the kernels that fill them with Kernel::run, and
/// is called again when one of the pools has grown. A report for each container, in order. After an
/// exception all of them are empty. Blocks.
///
///     auto [near, far] = cellist::build([&] { sort_out.run(n, near_lists, far_lists, points); },
///                                       near_lists, far_lists);
template <class... T>
    requires(sizeof...(T) > 0)
std::array<BuildReport, sizeof...(T)> build(std::invocable auto&& insert, Lists<T>&... lists) {
    const std::array<detail::ListsCore*, sizeof...(T)> cores{&lists.core()...};
    const std::vector<BuildReport> reports = detail::ListsCore::build(cores, insert);
    std::array<BuildReport, sizeof...(T)> result;
    std::copy(reports.begin(), reports.end(), result.begin());
    return result;
}

}  // namespace cellist
