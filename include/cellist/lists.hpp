// SPDX-License-Identifier: MIT
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

#include <cellist/detail/build.hpp>
#include <cellist/detail/lists_core.hpp>
#include <cellist/detail/owned.hpp>
#include <cellist/detail/readback.hpp>
#include <cellist/device.hpp>
#include <cellist/host_lists.hpp>
#include <cellist/kernel.hpp>
#include <cellist/neighbours.hpp>
#include <cellist/options.hpp>
#include <cellist/pending.hpp>
#include <cellist/report.hpp>
#include <cellist/shape.hpp>
#include <cellist/struct.hpp>
#include <cellist/value.hpp>

namespace cellist {

/// The lists of all cells in device memory, as contiguous lists. Cell c has the records (or one
/// member of each) records[offsets[c]] ... records[offsets[c + 1] - 1], and offsets[cells] is the
/// number of records. The buffer may have room for more records if the lists were packed while
/// their build was pending.
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

/// A list of records T for each cell of a shape, in device memory. T is an adapted struct, a scalar
/// or a vector, e.g. `Lists<cl_uint>` for ids.
///
/// Kernels fill the lists concurrently, with cellist_insert; kernels/cellist/lists.clh has every
/// call that kernels may make. In Storage::linked, heads take 4 bytes per cell. A node takes the
/// record rounded up to 4 bytes, a 4-byte link, and padding to its alignment. docs/storages.md has
/// the other storages.
///
/// Owned by value: movable, not copyable. Using moved-from Lists throws Error. The library enqueues
/// its work on the device's queue. Calls that return results block until they have them. sort() and
/// partial_sort() block until the lengths of the lists are known. Other calls block only while they
/// compile kernels, or to finish a pending build. Under Overflow::drop they need not finish it,
/// unless the storage is automatic; clear(), sort() and builds finish it under any policy.
///
/// All functions except shape() and those that report sizes throw:
/// - OpenClError if an OpenCL call fails.
/// - MemoryError if the host, the device's largest allocation or the budget has no room for the
///   result or the buffers; see out_of_memory().
/// - what a pending build throws, if the function finishes that build.
/// - Error if a build's function uses the lists that the build fills.
///
/// A comment names further exceptions. After an exception from a build or from clear(), the lists
/// are empty. After an exception from append(), merge() or remove_if(), they hold the same records
/// as before. They are empty if the device fails again while it restores them. Other functions
/// keep the records, unless the comment says otherwise.
template <class T>
class Lists {
    static_assert(detail::Record<T>, "adapt the record with CELLIST_STRUCT first");

public:
    /// Makes empty lists. Throws MemoryError if the shape or the capacity exceeds a limit of the
    /// device or the budget. Throws Error if the options contradict each other, or if nearest()
    /// names a member of another record.
    Lists(const Device& device, const Shape& shape, const ListsOptions& options = {})
        : core_("a Lists object",
                std::make_shared<detail::ListsCore>(
                    device.state(), detail::definitions_of_record<T>(), shape, options)) {}
    Lists(Lists&&) noexcept = default;
    Lists& operator=(Lists&&) noexcept = default;
    Lists(const Lists&) = delete;
    Lists& operator=(const Lists&) = delete;
    ~Lists() = default;

    /// Builds the lists: clears them, then runs `kernel(lists, args...)` over `range`. The lists
    /// are the kernel's first argument; `args` are the rest. Run kernels that read the old records
    /// before the build.
    ///
    /// If the pool is too small, the overflow policy decides. Overflow::grow enlarges it to the
    /// exact demand and runs the kernel again. Overflow::stop throws OverflowError, and so does a
    /// demand over the budget or the device's limit. Overflow::drop keeps the records that fit.
    ///
    /// The kernel must insert the same records in every run. Throws Error if a run finds that it
    /// did not. Other containers among `args` are read-only: if the kernel inserts into one, the
    /// build throws Error, and the message names the container. Blocks until the report is
    /// available.
    template <class... Args>
    BuildReport build(Kernel& kernel, const Range& range, const Args&... args) {
        return core_->build([&] { run(kernel, range, args...); });
    }

    /// Builds the lists with several kernels. `insert` enqueues them all with Kernel::run. The
    /// build calls it once for each run of the kernels. `insert` cannot build, clear, sort or read
    /// these lists: each of these throws Error. Its kernels may, in Storage::linked and
    /// Storage::fixed, read the records that earlier kernels of the same run have inserted. Throws
    /// what `insert` throws.
    BuildReport build(std::invocable auto&& insert) { return core_->build(std::ref(insert)); }

    /// Starts the same build. The event completes after the first pass. get() runs more passes if
    /// the pool was too small, or throws. Blocks only for an earlier pending build of these lists.
    ///
    /// The call itself throws what the first run of the kernels throws, e.g. what `insert` throws.
    /// get() throws what the review of the passes finds, and what later runs throw.
    ///
    /// Until get(), the lists are incomplete, unless the policy is Overflow::drop. A call that uses
    /// them finishes the build itself: it blocks, and throws what get() would throw. Keep the
    /// kernel, and the buffers and images passed to it, alive until then. You may destroy the Lists
    /// object earlier; get() still returns the report.
    template <class... Args>
    [[nodiscard]] Pending<BuildReport> build_async(Kernel& kernel, const Range& range,
                                                   const Args&... args) {
        return build_async(run_later(kernel, range, args...));
    }
    [[nodiscard]] Pending<BuildReport> build_async(std::invocable auto&& insert) {
        return start(std::forward<decltype(insert)>(insert), detail::Existing::cleared);
    }

    /// Adds records to the lists: works as build(), but keeps the records that are there. The
    /// report counts these as `existing`. After an exception the lists hold the existing records
    /// alone.
    ///
    /// If the pool is too small, Overflow::grow enlarges it by half, or to the exact demand if that
    /// is more or if half does not fit. Overflow::stop throws OverflowError. Overflow::drop drops
    /// new records only. A storage of nearest() keeps the nearest of the existing and the new
    /// records.
    ///
    /// In Storage::linked and Storage::fixed, an append takes the time of its own inserts, unless
    /// the pool grows. Storage::fixed also copies and sums its counts. Storage::counted copies the
    /// existing records, moves them to their new places, and runs the kernel twice. In all other
    /// cases the append copies the existing records and inserts them again, which takes about as
    /// long as a build of all records. Copies take device memory. The order in a list is undefined
    /// afterwards.
    template <class... Args>
    BuildReport append(Kernel& kernel, const Range& range, const Args&... args) {
        return core_->append([&] { run(kernel, range, args...); });
    }
    BuildReport append(std::invocable auto&& insert) { return core_->append(std::ref(insert)); }

    /// Starts the same append; see build_async().
    template <class... Args>
    [[nodiscard]] Pending<BuildReport> append_async(Kernel& kernel, const Range& range,
                                                    const Args&... args) {
        return append_async(run_later(kernel, range, args...));
    }
    [[nodiscard]] Pending<BuildReport> append_async(std::invocable auto&& insert) {
        return start(std::forward<decltype(insert)>(insert), detail::Existing::kept);
    }

    /// Appends the records of `other`, which keeps them. The report is that of an append. Throws
    /// Error if `other` is the same object or has another shape, and what append() throws. Blocks.
    BuildReport merge(const Lists& other) { return core_->merge(other.core()); }

    /// Returns lists with the same options, which hold the same records in the same order. Throws
    /// what the constructor throws. Blocks.
    [[nodiscard]] Lists copy() const { return Lists(core_->copy()); }

    /// Removes the records for which an OpenCL C expression of `record` and of values is not 0.
    /// Returns the number of removed records. The other records keep their order. The room of the
    /// removed records is free for later appends. Throws what sort_by() throws for an expression.
    ///
    ///     particles.remove_if("record.age > limit", {{"limit", 3.0f}});
    ///
    /// Takes device memory for a copy of all records. Blocks.
    std::uint64_t remove_if(const std::string& expression, const Values& values = {}) {
        return core_->remove_if(expression, values);
    }

    /// Builds more records than the pool may hold, a range of cells at a time. The budget, the
    /// device's largest allocation and, unless the policy is to grow, capacity_nodes bound a slice.
    ///
    /// `insert` enqueues the kernels as in build(). It runs once to count the records, then once
    /// for each slice, or twice in Storage::counted, to store them. The kernels must insert the
    /// same records every time. `read` runs for each slice, in order. It finds the lists of the
    /// slice's cells; all other lists are empty. `read` cannot build the lists: that throws Error.
    /// At the end all lists are empty.
    ///
    /// Throws OverflowError if a single list does not fit, except under Overflow::drop. Throws
    /// Error if the kernels insert other records than they counted. Throws what `insert` or `read`
    /// throws. The counts take 8 bytes per cell on the device until the first slice. Blocks.
    BuildReport build_slices(std::invocable auto&& insert,
                             std::invocable<const Slice&> auto&& read) {
        return core_->build_slices(std::ref(insert), std::ref(read));
    }

    /// Empties the lists; the pool keeps its capacity. Blocks only for a pending build, under any
    /// policy.
    void clear() { core_->clear(); }

    /// Sorts every list, of any length, by a scalar member: cellist_for_each then visits the least
    /// record first, or the greatest. The remaining members order records with equal keys,
    /// ascending, in order of declaration. So the result depends only on the records, not on the
    /// order of insertion. Floats are ordered -inf < ... < -0 < +0 < ... < +inf < NaN.
    ///
    /// Linked lists move to a second pool, each in one piece. pool_bytes() includes that pool, and
    /// the next sort reuses it. In the other storages, only lists of some hundred nodes or more
    /// need a second pool. Without memory for it, sort() works as sort_async() does.
    ///
    /// Blocks until the lengths of the lists are known. The first sort by a member compiles
    /// kernels. Throws Error if links lead in circles, out of the pool, or from several lists to
    /// the same nodes. Throws Error if offsets descend or leave the pool, or if the number of nodes
    /// differs from that of the last build. A sort without memory for more buffers checks nothing;
    /// validate() checks more. After any failure, sound lists keep their records.
    template <class M, std::same_as<T> R>
    cl::Event sort(M R::*member, Order order = Order::ascending) {
        return core_->sort(key_of(member, order), all_nodes);
    }
    /// The same for records that are scalars.
    cl::Event sort(Order order = Order::ascending) requires detail::Scalar<T> {
        return core_->sort(key_of(order), all_nodes);
    }

    /// Sorts every list by an OpenCL C expression of `record` with an integer or float value, such
    /// as "record.depth * record.depth". Throws OpenClError with the compiler's log if the
    /// expression does not compile. Throws Error if it is more than one expression, or if it
    /// writes. It refuses commas outside parentheses, quoted text, directives, assignments,
    /// pointers, and calls that write.
    ///
    /// No record is lost if the value differs between calls, for example after a division by 0 or
    /// with get_global_id(). The lists are then in no particular order. The expression is your code
    /// and runs inside the library's kernel. Undefined operations are your risk: an index outside
    /// an array can end the process on a CPU.
    ///
    /// Values are names for the expression, which the kernels take as arguments: another value of
    /// the same type compiles nothing. The expression need not use them all. Throws Error for an
    /// invalid name (see Value), and if all values together take more than 512 bytes.
    ///
    ///     hits.sort_by("distance(record.position, query)", {{"query", point}});
    cl::Event sort_by(const std::string& expression, Order order = Order::ascending) {
        return sort_by(expression, {}, order);
    }
    cl::Event sort_by(const std::string& expression, const Values& values,
                      Order order = Order::ascending) {
        return core_->sort({expression, 64, order, values}, all_nodes);
    }

    /// Sorts only the first `count` nodes of every list: the nodes that sort() would put there. The
    /// others follow in any order. Works as sort() if finding these nodes does not pay. It pays for
    /// a `count` of up to 64 records, 4 KiB in all, if lists have a mean length of at least 512
    /// nodes on GPUs, or `8 * count` on CPUs.
    template <class M, std::same_as<T> R>
    cl::Event partial_sort(M R::*member, std::uint32_t count, Order order = Order::ascending) {
        return core_->sort(key_of(member, order), count);
    }
    cl::Event partial_sort(std::uint32_t count,
                           Order order = Order::ascending) requires detail::Scalar<T> {
        return core_->sort(key_of(order), count);
    }
    cl::Event partial_sort_by(const std::string& expression, std::uint32_t count,
                              Order order = Order::ascending) {
        return partial_sort_by(expression, {}, count, order);
    }
    cl::Event partial_sort_by(const std::string& expression, const Values& values,
                              std::uint32_t count, Order order = Order::ascending) {
        return core_->sort({expression, 64, order, values}, count);
    }

    /// Sorts without blocking and without a second pool. One work-item sorts each list in place,
    /// which takes longer for most lists. Throws what sort_by() throws for an expression. Requires
    /// sound lists: if links lead in circles, the sort ends, but the lists have undefined content.
    template <class M, std::same_as<T> R>
    cl::Event sort_async(M R::*member, Order order = Order::ascending) {
        return core_->sort_async(key_of(member, order));
    }
    cl::Event sort_async(Order order = Order::ascending) requires detail::Scalar<T> {
        return core_->sort_async(key_of(order));
    }
    cl::Event sort_by_async(const std::string& expression, Order order = Order::ascending) {
        return sort_by_async(expression, {}, order);
    }
    cl::Event sort_by_async(const std::string& expression, const Values& values,
                            Order order = Order::ascending) {
        return core_->sort_async({expression, 64, order, values});
    }

    /// Measures the lists. Blocks.
    [[nodiscard]] Lengths lengths() const { return lengths_async().get(); }
    /// Like lengths(), but does not block.
    [[nodiscard]] Pending<Lengths> lengths_async() const {
        struct State {
            std::vector<cl_uint> lengths;
            detail::ReadbackFence done;
        };
        const auto state = std::make_shared<State>();
        state->done.add(core_->read_lengths(state->lengths));
        return {state->done.event(), [state] {
                    state->done.wait();
                    return Lengths(state->lengths);
                }};
    }

    /// Returns the length of every list, in device memory. Does not pack the lists. Does not block.
    [[nodiscard]] Buffer<cl_uint> device_lengths() const {
        Buffer<cl_uint> lengths(core_->device(), shape().cells());
        core_->write_lengths(lengths.cl());
        return lengths;
    }
    /// Returns the prefix sums of the lengths, cells + 1 elements in device memory: where each list
    /// begins in Packed::records, and the number of records. Does not pack the lists. Does not
    /// block.
    [[nodiscard]] Buffer<cl_uint> device_offsets() const {
        Buffer<cl_uint> offsets(core_->device(), shape().cells() + 1);
        core_->write_offsets(offsets.cl());
        return offsets;
    }
    /// Returns a histogram of the lengths, `bins` elements in device memory. Element n is the
    /// number of cells whose list has n records. The last element also counts all longer lists.
    /// Throws Error if `bins` is 0. Does not block.
    [[nodiscard]] Buffer<cl_uint> device_histogram(std::uint32_t bins) const {
        if (bins == 0) throw Error("a histogram needs at least one bin");
        Buffer<cl_uint> histogram(core_->device(), bins);
        histogram.fill(0);
        core_->write_histogram(histogram.cl(), bins);
        return histogram;
    }

    /// Copies all lists to host memory. Blocks.
    [[nodiscard]] HostLists<T> download() const { return download_async().get(); }
    /// Like download(), but does not block if the records take up to 256 MiB and fit into one
    /// device allocation. While a build under Overflow::drop is pending, the number of records is
    /// unknown. The call then copies the whole pool, and these limits apply to the pool.
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
                    auto offsets = detail::host_memory<std::uint64_t>(state->offsets.size());
                    std::copy(state->offsets.begin(), state->offsets.end(), offsets.begin());
                    return HostLists<T>(shape, std::move(offsets), std::move(state->records));
                }};
    }

    /// Copies all lists to plain device buffers, as contiguous lists, for kernels that do not use
    /// the container. Blocks only for a pending build that may still change the lists. While a
    /// build under Overflow::drop is pending, the copy has room for capacity_nodes() records.
    [[nodiscard]] Packed<T> pack() const { return pack_values<T, T>(""); }
    /// Like pack(), for readers that need only one member. Its type may be a scalar, a vector, an
    /// adapted struct or an array; `cl_float[4]` gives `Packed<std::array<cl_float, 4>>`.
    template <class M, std::same_as<T> R>
    [[nodiscard]] Packed<typename detail::Element<M>::type> pack(M R::*member) const {
        return pack_values<M, typename detail::Element<M>::type>(std::string(".") +
                                                                 detail::member_name(member));
    }

    /// Finds the neighbours of every record: the other records up to a distance, in the cells
    /// around the record's own. An index is a record's place in pack(), or the value of the member
    /// `index`. Places stay the same until the lists are built or sorted. Pass the last result as
    /// `reuse` to keep its buffers.
    ///
    ///     auto found = particles.neighbours({.distance = "distance(record.at, other.at)",
    ///                                        .radius = 0.1f});
    ///
    /// Takes 4 bytes of device memory per record for counts, and another 4 on GPUs. Storages other
    /// than Storage::counted also need a copy of all records. Blocks until the number of pairs is
    /// known, and while it compiles kernels. Throws Error for an invalid expression or value.
    /// Throws MemoryError if there are more than 2^32 - 1 pairs.
    [[nodiscard]] Neighbours neighbours(const NeighbourOptions& options,
                                        Neighbours reuse = {}) const {
        detail::find_neighbours(*core_, options, "", reuse);
        return reuse;
    }
    template <std::same_as<T> R>
    [[nodiscard]] Neighbours neighbours(cl_uint R::*index, const NeighbourOptions& options,
                                        Neighbours reuse = {}) const {
        detail::find_neighbours(*core_, options, detail::member_name(index), reuse);
        return reuse;
    }

    /// Finds the k records nearest to each query, in the cells around the query: with their
    /// distances, nearest first. The members order records with equal distances, as in sort(). So
    /// the result does not depend on the order of insertion. A query is a scalar, a vector, or an
    /// adapted struct, and may be outside of the shape. Pass the last result as `reuse` to keep its
    /// buffers.
    ///
    ///     auto found = photons.nearest(queries, {.k = 50,
    ///                                            .position = "query.xyz / 0.1f",
    ///                                            .distance = "distance(record.at, query)",
    ///                                            .radius = 0.1f});
    ///
    /// Blocks only for a pending build, and while it compiles kernels. Throws Error for an invalid
    /// expression or value, and if k exceeds 64.
    template <class Q>
    [[nodiscard]] Nearest<T> nearest(const Buffer<Q>& queries, const NearestOptions& options,
                                     Nearest<T> reuse = {}) const {
        static_assert(detail::KnownOnDevice<Q>);
        detail::check_nearest(options);
        const std::size_t count = queries.size();
        reuse.counts.reserve(core_->device(), count);
        reuse.records.reserve(core_->device(), count * options.k);
        reuse.distances.reserve(core_->device(), count * options.k);
        detail::find_nearest(
            *core_, options,
            {detail::definitions_of<Q>(), DeviceType<Q>::name(), queries.memory(), count,
             reuse.counts.memory(), reuse.records.memory(), reuse.distances.memory()});
        return reuse;
    }

    /// Checks that exactly one head reaches every allocated node, exactly once. Also counts inserts
    /// outside a build. Finds any corruption of heads and links, in time proportional to cells +
    /// nodes.
    ///
    /// Compares sums with those of the last build or append. Storage::counted compares the offsets
    /// with the counts of the last build, and Storage::fixed compares the counts with their hash.
    /// So both find a word that has changed. Takes one bit of device memory per node in
    /// Storage::linked, and 4 bytes per cell in Storage::counted. Blocks.
    [[nodiscard]] Validation validate() const { return core_->validate()(); }
    /// Like validate(), but does not block.
    [[nodiscard]] Pending<Validation> validate_async() const {
        std::function<Validation()> result = core_->validate();
        return {core_->enqueue_marker(),
                [core = core_, result = std::move(result)] { return result(); }};
    }

    [[nodiscard]] const Shape& shape() const { return core_->shape(); }
    /// Returns the number of records that are certain to fit.
    [[nodiscard]] std::uint64_t capacity_nodes() const { return core_->capacity_nodes(); }
    /// Returns the size of all device memory that the container keeps: heads, nodes, counters, and
    /// the buffers for reuse by sorts, downloads and builds. budget_bytes bounds it.
    [[nodiscard]] std::uint64_t pool_bytes() const { return core_->pool_bytes(); }
    /// Returns the storage in use. In Storage::automatic it is the storage of the last build.
    [[nodiscard]] Storage storage() const { return core_->storage_in_use(); }
    /// Returns a readable sentence: the storage of the next build, and the measurements that led
    /// to it.
    [[nodiscard]] std::string storage_reason() const { return core_->storage_reason(); }

    /// @private
    [[nodiscard]] detail::ListsCore& core() const { return *core_; }

private:
    explicit Lists(std::shared_ptr<detail::ListsCore> core)
        : core_("a Lists object", std::move(core)) {}

    /// Enqueues a kernel with these lists as its first argument.
    template <class... Args>
    void run(Kernel& kernel, const Range& range, const Args&... args) {
        detail::Arguments arguments;
        arguments.add(*this);
        (arguments.add(args), ...);
        kernel.enqueue(range, arguments);
    }
    /// Returns a function that does the same later, with the present values of the arguments.
    template <class... Args>
    auto run_later(Kernel& kernel, const Range& range, const Args&... args) {
        detail::Arguments rest;
        (rest.add(args), ...);
        return [core = core_.get(), & kernel, range, rest = std::move(rest)] {
            detail::Arguments arguments;
            core->add_to(arguments);
            arguments.append(rest);
            kernel.enqueue(range, arguments);
        };
    }
    Pending<BuildReport> start(std::function<void()> insert, detail::Existing existing) {
        const auto build = detail::Build::start({core_.get()}, std::move(insert), existing);
        return {build->enqueue_marker(), [core = core_, build] { return build->finish().front(); }};
    }

    static constexpr std::uint32_t all_nodes = std::numeric_limits<std::uint32_t>::max();

    template <class M, class R>
    static detail::SortKey key_of(M R::*member, Order order) {
        static_assert(detail::Scalar<M>,
                      "records are ordered by a scalar member, or by an expression");
        return {std::string("record.") + detail::member_name(member), sizeof(M) <= 4 ? 32u : 64u,
                order};
    }
    static detail::SortKey key_of(Order order) {
        return {"record", sizeof(T) <= 4 ? 32u : 64u, order};
    }

    /// Packs the value of type M that `member` selects from each record.
    template <class M, class E>
    Packed<E> pack_values(const std::string& member) const {
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
    const std::vector<BuildReport>& all = build.finish();
    for (std::size_t i = 0; i < count; ++i) result[i] = all[i];
    return result;
}

}  // namespace detail

/// Builds several containers at once. `insert` enqueues the kernels that fill them with
/// Kernel::run. The build calls it again if one of the pools has grown. Returns a report for each
/// container, in order. After an exception all of them are empty. Blocks.
///
/// The containers must belong to Devices with one device and context. Throws Error otherwise, and
/// if a container is named twice. Also throws what Lists::build and `insert` throw.
///
///     auto [near, far] = cellist::build([&] { sort_out.run(n, near_lists, far_lists, points); },
///                                       near_lists, far_lists);
template <class... T>
    requires(sizeof...(T) > 0)
std::array<BuildReport, sizeof...(T)> build(std::invocable auto&& insert, Lists<T>&... lists) {
    return detail::reports<sizeof...(T)>(
        *detail::Build::start({&lists.core()...}, std::ref(insert)));
}

/// Starts the same build and does not block; see Lists::build_async. The call itself throws Error
/// if the containers cannot be built together, and what `insert` throws in its first run. get()
/// throws the rest. If one of the containers is destroyed before get(), the others are empty and
/// get() throws Error.
template <class... T>
    requires(sizeof...(T) > 0)
[[nodiscard]] Pending<std::array<BuildReport, sizeof...(T)>> build_async(
    std::invocable auto&& insert, Lists<T>&... lists) {
    const auto build =
        detail::Build::start({&lists.core()...}, std::forward<decltype(insert)>(insert));
    return {build->enqueue_marker(), [build] { return detail::reports<sizeof...(T)>(*build); }};
}

}  // namespace cellist
