#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <cellist/detail/lists_core.hpp>
#include <cellist/detail/owned.hpp>
#include <cellist/detail/readback.hpp>
#include <cellist/device.hpp>
#include <cellist/host_lists.hpp>
#include <cellist/kernel.hpp>
#include <cellist/options.hpp>
#include <cellist/pending.hpp>
#include <cellist/report.hpp>
#include <cellist/shape.hpp>
#include <cellist/struct.hpp>

namespace cellist {

/// The lists of all cells in device memory, one after the other: the records of cell c, or a member
/// of each, are records[offsets[c]] ... records[offsets[c + 1] - 1]. There are offsets[cells]
/// records. The buffer may have room for more, if the lists were packed while their build was
/// pending.
template <class T>
struct Packed {
    Buffer<cl_uint> offsets;  ///< cells + 1
    Buffer<T> records;
};

namespace detail {

/// The type of a member as an element of a buffer: std::array for an array.
template <class M>
struct Element {
    using type = M;
};
template <class M, std::size_t count>
struct Element<M[count]> {
    using type = std::array<typename Element<M>::type, count>;
};

}  // namespace detail

/// A list of records T for each cell of a shape, in device memory.
///
/// Kernels fill the lists concurrently, with cellist_insert; see kernels/cellist/lists.clh for what
/// they can do. The heads take 4 bytes a cell, and a node takes the record and 4 bytes, rounded up
/// to the alignment of both.
///
/// Owned by value, movable, not copyable; every use of moved-from Lists throws Error. Work for the
/// device is enqueued on its queue. Calls that return results block until they have them. The
/// others do not block, with one exception: a call that uses lists with a pending build finishes
/// that build first, and blocks, if it may still change the lists. Under Overflow::drop a pending
/// build cannot change them, unless the storage is automatic.
///
/// All functions but shape() and those that only report sizes throw:
/// - OpenClError if an OpenCL call fails.
/// - MemoryError if a result exceeds the memory of the host, the device's largest allocation or
///   the budget; see out_of_memory().
/// - what a pending build throws, if the function ends that build.
/// - Error if the function that inserts uses the lists that it fills.
///
/// Where a function throws more than that, its comment says so. After an exception from a build or
/// from clear() the lists are empty; other functions leave them as they are, unless the comment
/// says otherwise.
template <class T>
class Lists {
    static_assert(detail::Adapted<T>, "adapt the record with CELLIST_STRUCT first");

public:
    /// Empty lists. Throws MemoryError if the shape or the capacity exceeds a limit of the device
    /// or of the budget, and Error if the options contradict each other.
    Lists(const Device& device, const Shape& shape, const ListsOptions& options = {})
        : core_("a Lists object",
                std::make_shared<detail::ListsCore>(device.state(), detail::definitions_of<T>(),
                                                    shape, options)) {}
    Lists(Lists&&) noexcept = default;
    Lists& operator=(Lists&&) noexcept = default;
    Lists(const Lists&) = delete;
    Lists& operator=(const Lists&) = delete;
    ~Lists() = default;

    /// Fills the lists anew: clears them, then runs `kernel(lists, args...)` over `range`. The
    /// lists are the kernel's first parameters; `args` are the rest. The old records are gone when
    /// the kernel runs: run a kernel that reads them before the build.
    ///
    /// Other containers among `args` are read-only. If the kernel inserts into one, the build
    /// throws Error with a message that names the container. Throws Error if a kernel does not
    /// insert the same records in a pass that needs them again.
    ///
    /// If the pool is too small, the overflow policy decides: grow enlarges it to the exact demand
    /// and runs the kernel again, which must insert the same records again; stop and a demand over
    /// the budget or the device's limit throw OverflowError; drop keeps what fits. After an
    /// exception the lists are empty. Blocks until the report is there.
    template <class... Args>
    BuildReport build(Kernel& kernel, const Range& range, const Args&... args) {
        return core_->build([&] {
            detail::Arguments arguments;
            arguments.add(*this);
            (arguments.add(args), ...);
            kernel.enqueue(range, arguments);
        });
    }

    /// The same for several inserting kernels: `insert` enqueues all of them with Kernel::run, and
    /// is called again after the pool has grown. `insert` cannot build, clear, sort or read these
    /// lists: each of these throws Error.
    BuildReport build(std::invocable auto&& insert) { return core_->build(std::ref(insert)); }

    /// Starts the same build. Blocks only for an earlier build of these lists that is still
    /// pending. The event completes after the first pass; get() runs more passes if the pool was
    /// too small, or throws. Until then the lists are incomplete, unless the policy is
    /// Overflow::drop: a call that uses them finishes the build itself, blocks, and throws what
    /// get() would throw. The kernel and the memory among the arguments must stay alive until then.
    /// The Lists object may be destroyed before: get() still returns the report.
    template <class... Args>
    [[nodiscard]] Pending<BuildReport> build_async(Kernel& kernel, const Range& range,
                                                   const Args&... args) {
        detail::Arguments rest;
        (rest.add(args), ...);
        return build_async([core = core_.get(), & kernel, range, rest = std::move(rest)] {
            detail::Arguments arguments;
            core->add_to(arguments);
            arguments.append(rest);
            kernel.enqueue(range, arguments);
        });
    }
    [[nodiscard]] Pending<BuildReport> build_async(std::invocable auto&& insert) {
        const auto build =
            detail::ListsCore::start_build({core_.get()}, std::forward<decltype(insert)>(insert));
        return {detail::ListsCore::marker(*build),
                [core = core_, build] { return finish(*build); }};
    }

    /// Builds lists that are more than the pool may hold (by the budget, by the device's largest
    /// allocation, by capacity_nodes unless the policy is to grow), a range of cells at a time.
    /// `insert` enqueues the kernels as in build(): once to count, then for each slice, of which it
    /// stores the records. `read` is called for each slice, in order, with the lists of its cells
    /// in place and all others empty. The kernels must insert the same records every time. At the
    /// end the lists are empty. Throws OverflowError if a single list does not fit and the policy
    /// is not to drop, and Error if the kernels insert other records than they counted. `read`
    /// cannot build the lists: that throws Error. Takes 8 bytes a cell for the counts. Blocks.
    BuildReport build_slices(std::invocable auto&& insert,
                             std::invocable<const Slice&> auto&& read) {
        return core_->build_slices(std::ref(insert), std::ref(read));
    }

    /// Empties the lists; the pool keeps its capacity. Blocks only for a pending build, under any
    /// policy.
    void clear() { core_->clear(); }

    /// Sorts every list by a scalar member: cellist_for_each then visits the least first, or the
    /// greatest. Records with equal keys are ordered by their remaining members, ascending, in
    /// order of declaration, so the result depends on the records alone and not on the order of
    /// insertion. Floats are ordered -inf < ... < -0 < +0 < ... < +inf < NaN. Lists have any
    /// length.
    ///
    /// Linked lists move to a second pool, each in one piece; it is counted in pool_bytes() and
    /// kept for the next sort. Lists of some hundred nodes or more need a second pool in the other
    /// storages as well. Where the budget or the device has no memory for it, lists are sorted as
    /// by sort_async().
    ///
    /// Blocks until it is known how long the lists are. The first calls for a member compile
    /// kernels. Throws Error where links lead in circles, out of the pool, or from several lists to
    /// the same nodes, where offsets descend or leave the pool, or where the lists do not have as
    /// many nodes as the last build stored. A sort without memory for more buffers checks nothing;
    /// validate() checks more. Whatever fails, sound lists keep their records.
    template <class M>
    cl::Event sort(M T::*member, Order order = Order::ascending) {
        return core_->sort(key_of(member, order), all_nodes);
    }

    /// The same by an OpenCL C expression of `record`, of integer or float type, such as
    /// "record.depth * record.depth". Throws OpenClError with the compiler's log if it does not
    /// compile, and Error if it is more than one expression, or writes: commas outside of
    /// parentheses, quoted text, directives, assignments, pointers and calls that write are
    /// refused. No record is lost where its value differs from call to call, as after a division by
    /// 0 or with get_global_id(). The lists are then in no particular order.
    ///
    /// The expression is your code, and runs inside the library's kernel. Undefined operations are
    /// your risk: an index outside an array can end the process on a CPU.
    cl::Event sort_by(const std::string& expression, Order order = Order::ascending) {
        return core_->sort({expression, 64, order}, all_nodes);
    }

    /// Sorts the first `count` nodes of every list only: those that sort() would put there. The
    /// others follow in any order. Takes less time than sort() where lists are several times as
    /// long; is the same otherwise.
    template <class M>
    cl::Event partial_sort(M T::*member, std::uint32_t count, Order order = Order::ascending) {
        return core_->sort(key_of(member, order), count);
    }
    cl::Event partial_sort_by(const std::string& expression, std::uint32_t count,
                              Order order = Order::ascending) {
        return core_->sort({expression, 64, order}, count);
    }

    /// Sorts without blocking, and without a second pool: each list in its place, by one work-item,
    /// which takes longer for most lists. Throws what sort_by() throws for an expression. For sound
    /// lists only: where links lead in circles, it ends, and the lists may be anything.
    template <class M>
    cl::Event sort_async(M T::*member, Order order = Order::ascending) {
        return core_->sort_async(key_of(member, order));
    }
    cl::Event sort_by_async(const std::string& expression, Order order = Order::ascending) {
        return core_->sort_async({expression, 64, order});
    }

    /// How long the lists are. Blocks.
    [[nodiscard]] Lengths lengths() const { return lengths_async().get(); }
    /// The same without blocking.
    [[nodiscard]] Pending<Lengths> lengths_async() const {
        struct State {
            std::vector<cl_uint> lengths;
            detail::ReadbackFence done;
        };
        const auto state = std::make_shared<State>();
        state->done = core_->read_lengths(state->lengths);
        return {state->done.event(), [state] {
                    state->done.wait();
                    return Lengths(state->lengths);
                }};
    }

    /// A copy of all lists in host memory. Blocks.
    [[nodiscard]] HostLists<T> download() const { return download_async().get(); }
    /// The same. Does not block if the records take up to 256 MiB and fit into one allocation of
    /// the device. While a build under Overflow::drop is pending, the number of records is not
    /// known: the call copies the whole pool, and these limits are for the pool.
    [[nodiscard]] Pending<HostLists<T>> download_async() const {
        struct State {
            std::vector<cl_uint> offsets;
            std::vector<T> records;
            detail::ReadbackFence done;
        };
        const auto state = std::make_shared<State>();
        core_->download(state->done, state->offsets, [&](std::uint64_t count) -> void* {
            state->records = detail::host_memory<T>(count);
            return state->records.data();
        });
        return {state->done.event(), [state, shape = shape()] {
                    state->done.wait();
                    state->records.resize(state->offsets.back());
                    return HostLists<T>(shape, {state->offsets.begin(), state->offsets.end()},
                                        std::move(state->records));
                }};
    }

    /// A copy of all lists in device memory, one after the other, for kernels that leave the
    /// container. Blocks only for a pending build that may still change the lists. While a build
    /// under Overflow::drop is pending, the copy has room for capacity_nodes() records.
    [[nodiscard]] Packed<T> pack() const { return pack<T, T>(""); }
    /// The same for a single member, for readers that need only that member. Its type may be a
    /// scalar, a vector, an adapted struct or an array; `cl_float[4]` gives
    /// `Packed<std::array<cl_float, 4>>`.
    template <class M>
    [[nodiscard]] Packed<typename detail::Element<M>::type> pack(M T::*member) const {
        return pack<M, typename detail::Element<M>::type>(std::string(".") +
                                                          detail::member_name(member));
    }

    /// Checks that every allocated node is reached from exactly one head, exactly once. Finds any
    /// corruption of heads and links in time proportional to cells + nodes. Compares sums with
    /// those of the last build, and counts inserts outside a build. Storage::counted compares the
    /// offsets with the counts of the last build; Storage::fixed compares the counts with a hash of
    /// those counts. So both find a word that has changed. Takes one bit of device memory a node in
    /// Storage::linked, and 4 bytes a cell in Storage::counted. Blocks.
    [[nodiscard]] Validation validate() const { return core_->validate()(); }
    /// The same without blocking.
    [[nodiscard]] Pending<Validation> validate_async() const {
        std::function<Validation()> result = core_->validate();
        return {core_->marker(), [core = core_, result = std::move(result)] { return result(); }};
    }

    [[nodiscard]] const Shape& shape() const { return core_->shape(); }
    /// Nodes in the pool.
    [[nodiscard]] std::uint64_t capacity_nodes() const { return core_->capacity_nodes(); }
    /// Device memory of every buffer that the container keeps: heads, nodes, counters, and the
    /// buffers that sorts, downloads and builds keep for reuse. budget_bytes bounds it.
    [[nodiscard]] std::uint64_t pool_bytes() const { return core_->pool_bytes(); }
    /// The storage in use: in Storage::automatic the one of the last build.
    [[nodiscard]] Storage storage() const { return core_->storage_in_use(); }
    /// A sentence for people: which storage the next build takes, and the measurements that speak
    /// for it.
    [[nodiscard]] std::string storage_reason() const { return core_->storage_reason(); }

    /// @private
    [[nodiscard]] detail::ListsCore& core() const { return *core_; }

private:
    static constexpr std::uint32_t all_nodes = std::numeric_limits<std::uint32_t>::max();

    template <class M>
    static detail::SortKey key_of(M T::*member, Order order) {
        static_assert(detail::Scalar<M>,
                      "records are ordered by a scalar member, or by an expression");
        return {std::string("record.") + detail::member_name(member), sizeof(M) <= 4 ? 32u : 64u,
                order};
    }

    static const BuildReport& finish(detail::Build& build) {
        return detail::ListsCore::finish(build).front();
    }
    /// The value of type M that `member` selects from each record.
    template <class M, class E>
    Packed<E> pack(const std::string& member) const {
        static_assert(detail::KnownOnDevice<M> && sizeof(E) == sizeof(M));
        Packed<E> packed{{core_->device(), shape().cells() + 1}, {core_->device(), 0}};
        const auto allocate = [&](std::uint64_t count) -> const cl::Buffer& {
            packed.records = Buffer<E>(core_->device(), count);
            return packed.records.cl();
        };
        std::string declaration = DeviceType<M>::name() + " value";
        if constexpr (std::is_array_v<M>) declaration += DeviceType<M>::extents();
        core_->pack(packed.offsets.cl(), allocate, declaration, member);
        return packed;
    }

    detail::Owned<std::shared_ptr<detail::ListsCore>> core_;
};

namespace detail {

template <std::size_t count>
std::array<BuildReport, count> reports(Build& build) {
    std::array<BuildReport, count> result;
    const std::vector<BuildReport>& all = ListsCore::finish(build);
    for (std::size_t i = 0; i < count; ++i) result[i] = all[i];
    return result;
}

}  // namespace detail

/// Fills several containers at once: `insert` enqueues the kernels that fill them with Kernel::run,
/// and is called again when one of the pools has grown. A report for each container, in order.
/// After an exception all of them are empty. Blocks.
///
/// The containers belong to Devices of one device and context: build() throws Error for others, and
/// for a container that is named twice. It throws what Lists::build throws.
///
///     auto [near, far] = cellist::build([&] { sort_out.run(n, near_lists, far_lists, points); },
///                                       near_lists, far_lists);
template <class... T>
    requires(sizeof...(T) > 0)
std::array<BuildReport, sizeof...(T)> build(std::invocable auto&& insert, Lists<T>&... lists) {
    return detail::reports<sizeof...(T)>(
        *detail::ListsCore::start_build({&lists.core()...}, std::ref(insert)));
}

/// Starts the same and does not block; see Lists::build_async. If one of the containers is
/// destroyed before get(), the others are empty and get() throws Error.
template <class... T>
    requires(sizeof...(T) > 0)
[[nodiscard]] Pending<std::array<BuildReport, sizeof...(T)>> build_async(
    std::invocable auto&& insert, Lists<T>&... lists) {
    const auto build =
        detail::ListsCore::start_build({&lists.core()...}, std::forward<decltype(insert)>(insert));
    return {detail::ListsCore::marker(*build),
            [build] { return detail::reports<sizeof...(T)>(*build); }};
}

}  // namespace cellist
