// SPDX-License-Identifier: MIT
#include "sort/sort.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <type_traits>
#include <utility>

#include "cellist_kernels.hpp"
#include "device/preparation.hpp"

namespace cellist::detail {

namespace {

constexpr KernelFile classes_file{"sort_lists.cl", kernels::sort_lists_cl};
constexpr KernelFile long_lists_file{"sort_long.cl", kernels::sort_long_cl};

/// Nodes of the pool for one splitter of long linked lists; see sort_long.cl.
constexpr unsigned segment_bits = 9;

/// Longest list in which one work-item looks for the top k.
constexpr cl_uint top_k_length_max = 4096;

/// Whole work-groups, at least one: to prepare a sort, kernels run for no list.
Range groups_for(std::uint64_t items, std::size_t group) {
    return Range::padded(std::max<std::uint64_t>(items, 1), group);
}

/// Adds an argument, the arguments of a container, or other arguments.
template <class T>
void add(Arguments& arguments, const T& value) {
    if constexpr (std::is_base_of_v<ListStorage, T>)
        value.add_to(arguments);
    else if constexpr (std::is_same_v<T, Arguments>)
        arguments.append(value);
    else
        arguments.add(value);
}

template <class... T>
Arguments arguments_of(const T&... values) {
    Arguments arguments;
    (add(arguments, values), ...);
    return arguments;
}

std::string define(const char* name, unsigned value) {
    return std::string("#define CELLIST_SORT_") + name + " " + std::to_string(value) + "\n";
}

/// The type of the pieces in which large nodes move: the widest vector whose size divides a node.
/// Empty for small nodes, which move whole.
std::string piece_type(std::size_t node_bytes) {
    constexpr std::size_t whole_max = 256;
    if (node_bytes <= whole_max) return {};
    const char* const types[] = {"ulong16", "ulong8", "ulong4", "ulong2",
                                 "ulong",   "uint",   "ushort", "uchar"};
    std::size_t bytes = 128;
    for (const char* const type : types) {
        if (node_bytes % bytes == 0) return type;
        bytes /= 2;
    }
    return {};
}

/// What the kernels of a sort take from the host; see sort.cl. Tunings add to it.
std::string definitions_of(const RecordType& record, bool linked, const SortKey& key) {
    const std::string piece = piece_type(linked ? node_layout(record).size : record.size);
    return define("KEY_BITS", key.bits) + define("KEEPS_KEYS", is_member(key) ? 0 : 1) +
           define("SEGMENT_BITS", segment_bits) +
           (piece.empty() ? "" : "#define CELLIST_SORT_PIECE " + piece + "\n");
}

std::string definitions_of(const SortTuning& tuning) {
    return define("CHUNK_SIZE", tuning.chunk_size) + define("WIDTH", tuning.width) +
           define("ITEMS", tuning.items) + define("TEAM", tuning.team) +
           define("LISTS", tuning.lists) + define("MERGE_ITEMS", tuning.merge_items) +
           define("TOP_K", tuning.top_k);
}

}  // namespace

ListSorter::ListSorter(MemoryOwner device, RecordKernels& kernels)
    : device_(std::move(device)), kernels_(kernels), device_type_(device_->info.type) {}

Kernel& ListSorter::kernel(const KernelFile& file, const char* name, const Sort& sort,
                           const SortTuning& tuning) {
    return kernels_.get(
        {{"sort.cl", kernels::sort_cl}, {"sort_ties.cl", kernels::sort_ties_cl}, file}, name,
        sort.storage.mode(), definitions_of(tuning) + sort.definitions + sort.program.source,
        sort.program.types);
}

void ListSorter::clear_state() {
    constexpr cl_uint zero = 0;
    state_.fill(&zero, sizeof zero, sizeof(cellist_sort_state));
}

void ListSorter::read_state(Sort& sort) const {
    state_.read(&sort.state, sizeof sort.state);
    if (sort.state.broken > 0)
        throw Error(sort.linked
                        ? "lists cannot be sorted: links lead out of the pool, in circles, or from "
                          "several lists to the same nodes (Lists::validate() finds them)"
                        : "lists cannot be sorted: some end before they begin, or outside the pool "
                          "(Lists::validate() finds them)");
}

/// Throws Error where the lists do not have as many nodes as the last build stored.
void ListSorter::check_nodes(const Sort& sort) const {
    std::uint64_t nodes = sort.state.nodes;
    for (const cellist_sort_counter& counter : sort.state.in_place) nodes += counter.nodes;
    if (nodes == sort.storage.stored()) return;
    throw Error("lists cannot be sorted: they have " + std::to_string(nodes) +
                " nodes instead of " + std::to_string(sort.storage.stored()) +
                " (Lists::validate() finds why)");
}

/// Makes the state the first time. False where the budget has no room for it.
bool ListSorter::make_state(const Sort& sort) {
    if (state_.size_bytes() > 0) return true;
    if (!has_room_for(sort, sizeof(cellist_sort_state))) return false;
    state_ = Memory(device_, 1, sizeof(cellist_sort_state), "state of a sort");
    return true;
}

/// Whether a sort may take more memory.
bool ListSorter::has_room_for(const Sort& sort, std::uint64_t more_bytes) const {
    return sort.storage.pool().has_room_for(more_bytes);
}

ListSorter::Sort ListSorter::sort_of(ListStorage& storage, const SortKey& key) const {
    const bool linked = storage.mode() == CELLIST_LINKED;
    ExpressionProgram program = key_program(key);
    program.source += tie_function(key, kernels_.record());
    return {.storage = storage,
            .key = key,
            .plan = SortPlan(device_type_, device_->info, linked, kernels_.record().size),
            .linked = linked,
            .program = std::move(program),
            .definitions = definitions_of(kernels_.record(), linked, key),
            .count = storage.cells()};
}

cl::Event ListSorter::sort(ListStorage& storage, const SortKey& key, std::uint32_t top_k) {
    if (storage.cells() == 0 || top_k == 0) return device_->enqueue_marker();
    Sort sort = sort_of(storage, key);
    if (!make_state(sort)) return sort_in_place(storage, key);
    const bool preparing = Preparation::current() != nullptr;
    if (select_top_k(sort, top_k) && !preparing) return std::move(sort.done);
    if (sort.linked && storage.pool().back_buffer() == nullptr) return sort_in_place(storage, key);
    if (!has_room_for(sort,
                      2 * most_left(sort, sort.plan.of_class(first_class(sort))) * sizeof(cl_uint)))
        return sort_in_place(storage, key);
    const SortTuning tuning = sort_classes(sort);
    if (sort.count > 0) {
        sort_long(sort, tuning);
    } else {
        check_nodes(sort);
        if (sort.linked) swap_pools(sort, tuning);
    }
    if (preparing) rehearse(sort);
    return std::move(sort.done);
}

cl::Event ListSorter::sort_in_place(ListStorage& storage, const SortKey& key) {
    if (storage.cells() == 0) return device_->enqueue_marker();
    Sort sort = sort_of(storage, key);
    sort_in_place(sort);
    return std::move(sort.done);
}

/// Runs, for no list, the kernels that lists of other lengths need.
void ListSorter::rehearse(Sort& sort) {
    sort.is_rehearsal = true;
    sort.count = 0;
    sort.cells = nullptr;
    clear_state();
    for (std::size_t index = 0; index < sort.plan.classes(); ++index)
        sort_class(sort, sort.plan.of_class(index), 0);
    sort_long(sort, {});
}

/// The buffer that names the cells of the lists that are left, and 1; without such a buffer, all
/// lists are left, and any buffer and 0 take its place.
std::pair<const cl::Buffer&, cl_uint> ListSorter::cells_of(const Sort& sort) {
    if (sort.cells != nullptr) return {sort.cells->cl(), 1};
    return {sort.storage.pool().heads().cl(), 0};
}

/// Sorts the lists that are left without more memory.
void ListSorter::sort_in_place(Sort& sort) {
    const auto [cells, listed] = cells_of(sort);
    const auto count = static_cast<cl_uint>(sort.count);
    kernel({"sort_in_place.cl", kernels::sort_in_place_cl}, "cellist_sort_in_place", sort,
           sort.plan.of_long_lists())
        .enqueue(Range::padded(count, 64),
                 arguments_of(sort.storage, cells, listed, count, sort.program.values), &sort.done);
}

/// True if the top k records of every list are its first nodes then. False if lists are to be
/// sorted: because that takes less time, or there are long lists, or k is more than a work-item
/// keeps.
bool ListSorter::select_top_k(Sort& sort, std::uint32_t top_k) {
    const std::uint64_t mean = Preparation::current() != nullptr
                                   ? std::numeric_limits<std::uint64_t>::max()
                                   : sort.storage.stored() / sort.storage.cells();
    if (!sort.plan.top_k_is_faster(top_k, mean)) return false;
    const SortTuning tuning = sort.plan.of_top_k(top_k);
    clear_state();
    kernel({"sort_partial.cl", kernels::sort_partial_cl}, "cellist_sort_partial", sort, tuning)
        .enqueue(
            Range::padded((sort.count + tuning.lists - 1) / tuning.lists, 64),
            arguments_of(sort.storage, top_k, top_k_length_max, state_.cl(), sort.program.values),
            &sort.done);
    read_state(sort);
    if (sort.state.longer[0] > 0) return false;
    check_nodes(sort);
    return true;
}

/// The least class that has room for nearly all lists: by the last sort, or by the mean length.
std::size_t ListSorter::first_class(const Sort& sort) const {
    std::uint64_t longer = std::accumulate(in_class_.begin(), in_class_.end(), std::uint64_t{0});
    if (longer == 0)
        return sort.plan.class_for(sort.storage.stored() / sort.storage.cells() * 3 / 2);
    const std::uint64_t few = longer / 16;
    std::size_t index = 0;
    longer -= in_class_[0];
    while (index + 1 < sort.plan.classes() && longer > few) longer -= in_class_[++index];
    return index;
}

/// Sorts the lists that are not longer than those of the last class. Returns the tuning of the last
/// class that it sorted.
SortTuning ListSorter::sort_classes(Sort& sort) {
    clear_state();
    std::size_t index = first_class(sort);
    const std::size_t last = sort.plan.classes() - 1;
    for (cl_uint stage = 0;; ++stage) {
        sort_class(sort, sort.plan.of_class(index), stage);
        read_state(sort);
        sort.count = sort.state.longer[stage];
        if (sort.count == 0 || index == last) break;
        // Long lists are few: a class for each of their lengths would be more launches for little.
        index = std::min(index + 2, last);
    }
    std::copy_n(sort.state.in_class, CELLIST_SORT_CLASSES, in_class_.begin());
    in_class_.back() += static_cast<cl_uint>(sort.count);
    return sort.plan.of_class(index);
}

/// The most lists that a class can leave: in sound lists, only longer ones are left.
std::uint64_t ListSorter::most_left(const Sort& sort, const SortTuning& tuning) const {
    const std::uint64_t nodes = sort.storage.pool().nodes_count();
    return std::max<std::uint64_t>(std::min(sort.count, nodes / (tuning.chunk_size + 1)), 1);
}

/// Sorts a class of the lists that are left, and collects the cells of those that are longer.
void ListSorter::sort_class(Sort& sort, const SortTuning& tuning, cl_uint stage) {
    const ListStorage& storage = sort.storage;
    const std::uint64_t most = most_left(sort, tuning);
    Memory& longer = cells_[stage % 2];
    if (longer.size_bytes() < most * sizeof(cl_uint))
        longer = Memory(device_, most, sizeof(cl_uint), "cells with long lists");
    const auto [cells, listed] = cells_of(sort);
    Arguments arguments =
        arguments_of(storage, cells, listed, static_cast<cl_uint>(sort.count), longer.cl(),
                     static_cast<cl_uint>(most), stage, state_.cl(), sort.program.values);
    if (sort.linked) {
        const NodePool::BackBuffer* back_buffer = sort.storage.pool().back_buffer();
        arguments.add(back_buffer->heads.cl());
        arguments.add(back_buffer->nodes.cl());
    }
    const std::uint64_t together = (sort.count + tuning.lists - 1) / tuning.lists;
    kernel(classes_file, "cellist_sort_lists", sort, tuning)
        .enqueue(groups_for(together * tuning.items, tuning.items == 1 ? 64 : tuning.items),
                 arguments, &sort.done);
    sort.cells = &longer;
}

/// Sorts the lists that are left: makes each contiguous, sorts chunks of them, and merges these.
/// The tuning is that of a class that was sorted before.
void ListSorter::sort_long(Sort& sort, const SortTuning& class_tuning) {
    ListStorage& storage = sort.storage;
    const NodePool::BackBuffer* back_buffer = storage.pool().back_buffer();
    const std::optional<Keys> keys = back_buffer != nullptr ? keys_of(sort) : std::nullopt;
    if (!keys) {
        if (sort.linked && !sort.is_rehearsal) {
            // The lists that were sorted are in the back buffer, which is not used.
            sort.cells = nullptr;
            sort.count = storage.cells();
        }
        return sort_in_place(sort);
    }
    const SortTuning tuning = sort.plan.of_long_lists();
    const auto count = static_cast<cl_uint>(sort.count);
    const cl::Buffer& cells = cells_of(sort).first;
    const Memory long_lists(device_.state(), count, sizeof(cellist_sort_long_list), "long lists");
    const std::uint64_t chunks_max = storage.pool().nodes_count() / tuning.chunk_size + count;
    const Memory chunk_owners(device_.state(), chunks_max, sizeof(cl_uint), "owners of chunks");
    const std::uint64_t segment_count =
        sort.linked ? (storage.pool().nodes_count() >> segment_bits) + count : 0;
    const Memory segments(device_.state(), segment_count, sizeof(cl_uint2), "segments of lists");
    Memory offsets(device_.state(), segment_count, sizeof(cl_uint2), "offsets of segments");
    const Range traversals = groups_for((segment_count + tuning.lists - 1) / tuning.lists,
                                        sort.plan.in_groups() ? 64 : 16);

    Arguments assign = arguments_of(storage, cells, count, long_lists.cl(), chunk_owners.cl(),
                                    static_cast<cl_uint>(chunks_max), state_.cl());
    if (sort.linked) {
        constexpr cl_uint none = CELLIST_NONE;
        offsets.fill(&none, sizeof none, offsets.size_bytes());
        run_long(sort, "cellist_sort_measure", traversals,
                 arguments_of(storage, cells, count, segments.cl()));
        assign.add(segments.cl());
        assign.add(offsets.cl());
        assign.add(back_buffer->heads.cl());
    }
    run_long(sort, "cellist_sort_assign", groups_for(count, 64), assign);
    if (sort.linked)
        run_long(sort, "cellist_sort_gather", traversals,
                 arguments_of(storage, cells, count, long_lists.cl(), segments.cl(), offsets.cl(),
                              back_buffer->nodes.cl()));
    read_state(sort);
    if (!sort.is_rehearsal) {
        check_nodes(sort);
        if (sort.linked) swap_pools(sort, class_tuning);
    }
    merge(sort, long_lists, chunk_owners, *keys);
}

/// Buffers for keys; nothing where there is no memory for them.
std::optional<ListSorter::Keys> ListSorter::keys_of(const Sort& sort) const {
    const std::uint64_t count = is_member(sort.key) ? 0 : sort.storage.pool().nodes_count();
    const std::uint64_t bytes = count * sizeof(cl_ulong);
    if (bytes > device_->info.max_allocation_bytes || !has_room_for(sort, 2 * bytes)) return {};
    try {
        return Keys{Memory(device_.state(), count, sizeof(cl_ulong), "keys"),
                    Memory(device_.state(), count, sizeof(cl_ulong), "keys")};
    } catch (const OpenClError& error) {
        if (!out_of_memory(error)) throw;
        return {};
    }
}

/// Sorts long lists that are contiguous.
void ListSorter::merge(Sort& sort, const Memory& long_lists, const Memory& chunk_owners,
                       const Keys& keys) {
    const SortTuning tuning = sort.plan.of_long_lists();
    const cl_uint chunks = sort.state.chunks;
    const cl::Buffer& nodes = sort.storage.pool().nodes().cl();
    const cl::Buffer& back_buffer = sort.storage.pool().back_buffer()->nodes.cl();
    run_long(
        sort, "cellist_sort_chunks",
        groups_for(std::uint64_t{chunks} * tuning.items, tuning.items == 1 ? 16 : tuning.items),
        arguments_of(long_lists.cl(), chunk_owners.cl(), chunks, nodes, keys.of_pool.cl(),
                     state_.cl(), sort.program.values));

    const unsigned merges_a_chunk = std::max(tuning.chunk_size / tuning.merge_items, 1u);
    const Range merges =
        groups_for(std::uint64_t{chunks} * merges_a_chunk, sort.plan.in_groups() ? 128 : 16);
    const cl::Buffer* from = &nodes;
    const cl::Buffer* to = &back_buffer;
    const cl::Buffer* keys_from = &keys.of_pool.cl();
    const cl::Buffer* keys_to = &keys.of_back_buffer.cl();
    const std::uint64_t longest = sort.is_rehearsal ? 2 * tuning.chunk_size : sort.state.longest;
    for (std::uint64_t run = tuning.chunk_size; run < longest; run *= 2) {
        run_long(
            sort, "cellist_sort_merge_runs", merges,
            arguments_of(long_lists.cl(), chunk_owners.cl(), chunks, *from, *to,
                         static_cast<cl_uint>(run), *keys_from, *keys_to, sort.program.values));
        std::swap(from, to);
        std::swap(keys_from, keys_to);
    }
    const Arguments arguments =
        arguments_of(long_lists.cl(), chunk_owners.cl(), chunks, back_buffer, nodes);
    run_long(sort, "cellist_sort_return",
             groups_for(std::uint64_t{chunks} * tuning.chunk_size, 256), arguments);
    // PoCL compiles a kernel again for ranges of 65,536 work-items or more.
    if (sort.is_rehearsal)
        run_long(sort, "cellist_sort_return", groups_for(sort.storage.pool().nodes_count(), 256),
                 arguments);
}

/// Enqueues a kernel of sort_long.cl.
void ListSorter::run_long(Sort& sort, const char* name, const Range& range,
                          const Arguments& arguments) {
    kernel(long_lists_file, name, sort, sort.plan.of_long_lists())
        .enqueue(range, arguments, &sort.done);
}

/// Swaps the pools: all lists have moved to the back buffer. The tuning is that of a class that was
/// sorted before.
void ListSorter::swap_pools(Sort& sort, const SortTuning& tuning) {
    ListStorage& storage = sort.storage;
    const auto allocate = [&](const SortTuning& of_class) {
        Kernel& kernel_of_class = kernel(classes_file, "cellist_sort_allocate", sort, of_class);
        kernel_of_class.enqueue(Range::padded(storage.pool().counter_elements()),
                                arguments_of(storage, static_cast<cl_uint>(storage.stored())),
                                &sort.done);
    };
    if (storage.stored() < storage.pool().nodes_count()) allocate(tuning);
    if (Preparation::current() != nullptr)
        for (std::size_t index = 0; index < sort.plan.classes(); ++index)
            allocate(sort.plan.of_class(index));
    storage.pool().swap_back_buffer();
}

}  // namespace cellist::detail
