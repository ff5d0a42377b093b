#include "sort.hpp"

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <iostream>
#include <numeric>
#include <sstream>

#include "cellist_kernels.hpp"
#include "storage.hpp"

namespace cellist::detail {

namespace {

/// Nodes of the pool for one splitter of long linked lists; see sort_long.cl.
constexpr unsigned part_bits = 9;

/// Longest list whose first nodes are looked for by one work-item.
constexpr cl_uint front_length_max = 4096;
/// Private memory for the first records of a list.
constexpr std::size_t front_bytes_max = 4096;

template <class... T>
Arguments arguments_of(const T&... values) {
    Arguments arguments;
    (arguments.add(values), ...);
    return arguments;
}

template <class... T>
Arguments arguments_of(const ListStorage& storage, const T&... values) {
    Arguments arguments;
    storage.add_to(arguments);
    (arguments.add(values), ...);
    return arguments;
}

bool is_linked(const ListStorage& storage) { return storage.mode() == CELLIST_LINKED; }

std::string define(const char* name, unsigned value) {
    return std::string("#define CELLIST_SORT_") + name + " " + std::to_string(value) + "\n";
}

/// Defines cellist_sort_key.
std::string key_function(const SortKey& key) {
    const std::string type = key.bits == 32 ? "uint" : "ulong";
    // Where clang knows that a value is undefined, it is an error: the sort around it would be undefined
    // as well.
    return "#ifdef __clang__\n#pragma clang diagnostic push\n"
           "#pragma clang diagnostic error \"-Wdivision-by-zero\"\n"
           "#pragma clang diagnostic error \"-Warray-bounds\"\n#endif\n"
           "#line 1 \"sort expression\"\n"
           "static inline " +
           type + " cellist_sort_key(struct CELLIST_RECORD record) { return (" + type + ")" +
           (key.order == Order::descending ? "~" : "") +
           "cellist_order(\n#line 1 \"sort expression\"\n" + key.expression +
           "\n); }\n#ifdef __clang__\n#pragma clang diagnostic pop\n#endif\n";
}

}  // namespace

ListSorter::ListSorter(std::shared_ptr<DeviceState> device, Definitions definitions)
    : device_(std::move(device)),
      definitions_(std::move(definitions)),
      device_type_(device_->info.type),
      state_(device_, 1, sizeof(cellist_sort_state), "state of a sort") {}

// ---- how work is divided -------------------------------------------------------------------------

/// On GPUs there is a class for each power of two from 16 to 256; elsewhere one for all.
ListSorter::Tuning ListSorter::class_tuning(std::size_t index, bool linked) const {
    if (const char* tune = std::getenv("CELLIST_SORT_TUNE")) {
        std::istringstream in(tune);
        Tuning t{};
        for (std::size_t i = 0; i <= index; ++i)
            in >> t.slots >> t.width >> t.team >> t.items >> t.lists;
        return t;
    }
    if (!in_groups()) {
        // The records of a list that lies in one piece are copied to private memory.
        const std::size_t fit = std::bit_floor(std::size_t{65536} / record_bytes());
        const auto slots = static_cast<unsigned>(std::clamp<std::size_t>(fit, 8, 256));
        return {.slots = linked ? 256 : slots,
                .width = 8,
                .items = 1,
                .team = 1,
                .lists = linked ? 32u : 8u};
    }
    const unsigned slots = 16u << index;
    constexpr unsigned items = 128;
    constexpr unsigned width = 4;
    const unsigned team = slots / width;
    return {.slots = slots, .width = width, .items = items, .team = team, .lists = items / team};
}

ListSorter::Tuning ListSorter::long_tuning() const {
    if (const char* tune = std::getenv("CELLIST_SORT_LONG")) {
        std::istringstream in(tune);
        Tuning t{};
        in >> t.slots >> t.width >> t.team >> t.items >> t.lists >> t.share;
        return t;
    }
    if (!in_groups())
        return {.slots = 128, .width = 8, .items = 1, .team = 1, .lists = 32, .share = 1024};
    return {.slots = 256, .width = 4, .items = 64, .team = 64, .lists = 1, .share = 4};
}

/// The class that most lists belong to: by the last sort, or by the mean length.
std::size_t ListSorter::first_class(const ListStorage& storage) const {
    if (!in_groups() || std::getenv("CELLIST_SORT_TUNE")) return 0;
    constexpr std::size_t classes = CELLIST_SORT_LENGTHS - 1;
    const auto lists =
        std::accumulate(lengths_.begin(), lengths_.end(), std::uint64_t{0});
    std::size_t index = 0;
    if (lists == 0) {
        while (index + 1 < classes && storage.stored() / storage.cells() * 3 / 2 >= (16u << index))
            ++index;
        return index;
    }
    std::uint64_t longer = lists - lengths_[0];
    while (index + 1 < classes && longer > lists / 16) longer -= lengths_[++index];
    return index;
}

Kernel& ListSorter::kernel(const char* name, std::string_view source, const SortKey& key,
                           const Tuning& tuning) {
    std::string text = "#define CELLIST_RECORD " + definitions_.records.back().name + "\n" +
                       define("KEY_BITS", key.bits) + define("SLOTS", tuning.slots) +
                       define("WIDTH", tuning.width) + define("ITEMS", tuning.items) +
                       define("TEAM", tuning.team) + define("LISTS", tuning.lists) +
                       define("SHARE", tuning.share) + define("LEAST", tuning.least) +
                       define("PART_BITS", part_bits) + "#line 1 \"sort.cl\"\n";
    text += kernels::sort_cl;
    text += key_function(key) + "#line 1 \"" + name + ".cl\"\n";
    text += source;
    const std::string id = std::string(name) + std::to_string(definitions_.modes) + text;
    if (const auto known = kernels_.find(id); known != kernels_.end()) return known->second;
    return kernels_.emplace(id, Kernel(device_, Source{.text = text}, name, definitions_))
        .first->second;
}

// ---- the sort ------------------------------------------------------------------------------------

cl::Event ListSorter::sort(ListStorage& storage, const SortKey& key, std::uint32_t least) {
    definitions_.modes = storage.mode();
    Sort sort{.storage = storage, .key = key};
    if (storage.cells() == 0 || least == 0) return device_->marker();
    if (bring_to_front(sort, least)) return sort.done;
    if (is_linked(storage) && storage.spare() == nullptr) {
        sort_in_place(sort, false);
        return sort.done;
    }
    sort_classes(sort);
    if (sort.rest > 0)
        sort_long(sort);
    else if (is_linked(storage))
        adopt(sort);
    return sort.done;
}

void ListSorter::clear_state() {
    constexpr cl_uint zero = 0;
    state_.fill(&zero, sizeof zero, sizeof(cellist_sort_state));
}

void ListSorter::read_state(Sort& sort) {
    state_.read(&sort.state, sizeof sort.state);
    if (sort.state.broken > 0)
        throw Error("lists cannot be sorted: links lead in circles, or from several lists to the "
                    "same nodes (Lists::validate() finds them); the lists are as they were");
}

/// True if every list has its first records at its front then. False if that needs a sort: if there are
/// long lists, or more records than a work-item keeps.
bool ListSorter::bring_to_front(Sort& sort, std::uint32_t least) {
    if (least > 64 || least * record_bytes() > front_bytes_max) return false;
    const unsigned most = std::max(8u, std::bit_ceil(least));
    const unsigned lists = !in_groups() && is_linked(sort.storage) ? 16 : 1;
    const Tuning tuning{
        .slots = 8, .width = 8, .items = 1, .team = 1, .lists = lists, .least = most};
    clear_state();
    sort.done = kernel("cellist_sort_least", kernels::sort_least_cl, sort.key, tuning)
                    .enqueue(Range::padded((sort.storage.cells() + lists - 1) / lists, 64),
                             arguments_of(sort.storage, least, front_length_max, state_.cl()));
    if (sort.storage.capacity_nodes() <= front_length_max) return true;
    read_state(sort);
    return sort.state.longer[0] == 0;
}

/// Sorts the lists of all cells, or of those that are left, without more memory.
void ListSorter::sort_in_place(Sort& sort, bool listed) {
    const cl_uint count = listed ? sort.rest : static_cast<cl_uint>(sort.storage.cells());
    const cl::Buffer& cells = listed ? cells_[sort.rest_is_in].cl() : state_.cl();
    sort.done =
        kernel("cellist_sort_in_place", kernels::sort_in_place_cl, sort.key, long_tuning())
            .enqueue(Range::padded(count, 64),
                     arguments_of(sort.storage, cells, cl_uint{listed ? 1u : 0u}, count));
}

/// Sorts the lists that are not longer than those of the last class, and reads the state.
void ListSorter::sort_classes(Sort& sort) {
    clear_state();
    std::size_t index = first_class(sort.storage);
    const std::size_t last =
        std::getenv("CELLIST_SORT_TUNE") ? 1 : in_groups() ? CELLIST_SORT_LENGTHS - 2 : 0;
    for (cl_uint stage = 0;; ++stage) {
        const Tuning tuning = class_tuning(index, is_linked(sort.storage));
        sort_class(sort, tuning, stage > 0, stage);
        if (!is_linked(sort.storage) && sort.storage.capacity_nodes() <= tuning.slots) break;
        read_state(sort);
        sort.rest = sort.state.longer[stage];
        if (sort.rest == 0 || index == last) break;
        index = std::min(index + 2, last);
    }
    std::copy_n(sort.state.lengths, CELLIST_SORT_LENGTHS, lengths_.begin());
    lengths_.back() += sort.rest;
}

/// Sorts a class of all lists, or of those that are left.
void ListSorter::sort_class(Sort& sort, const Tuning& tuning, bool listed, cl_uint stage) {
    const ListStorage& storage = sort.storage;
    const std::uint64_t count = listed ? sort.rest : storage.cells();
    // Sound lists that are longer than the class are no more than this.
    const std::uint64_t most =
        std::min<std::uint64_t>(count, storage.capacity_nodes() / (tuning.slots + 1));
    const unsigned other = 1 - sort.rest_is_in;
    if (cells_[other].size_bytes() < most * sizeof(cl_uint) || cells_[other].cl()() == nullptr)
        cells_[other] = Memory(device_, most, sizeof(cl_uint), "cells with long lists");
    Arguments arguments =
        arguments_of(storage, cells_[sort.rest_is_in].cl()() == nullptr ? cells_[other].cl() : cells_[sort.rest_is_in].cl(), cl_uint{listed ? 1u : 0u},
                     static_cast<cl_uint>(count), cells_[other].cl(), static_cast<cl_uint>(most),
                     stage, state_.cl());
    if (const ListStorage::Spare* spare = is_linked(storage) ? sort.storage.spare() : nullptr) {
        arguments.add(spare->heads.cl());
        arguments.add(spare->nodes.cl());
    }
    const std::uint64_t together = (count + tuning.lists - 1) / tuning.lists;
    sort.done = kernel("cellist_sort_lists", kernels::sort_lists_cl, sort.key, tuning)
                    .enqueue(Range::padded(together * tuning.items,
                                           tuning.items == 1 ? 64 : tuning.items),
                             arguments);
    sort.rest_is_in = other;
}

/// Sorts the lists that are left.
void ListSorter::sort_long(Sort& sort) {
    ListStorage& storage = sort.storage;
    const ListStorage::Spare* spare = storage.spare();
    if (spare == nullptr) return sort_in_place(sort, true);
    const bool linked = is_linked(storage);
    const Tuning tuning = long_tuning();
    const auto run = [&](const char* name, const Range& range, const Arguments& arguments) {
        sort.done = kernel(name, kernels::sort_long_cl, sort.key, tuning).enqueue(range, arguments);
        if (std::getenv("TRACE")) {
            sort.done.wait();
            std::cout << "      " << name << " "
                      << 1e-6 * double(sort.done.getProfilingInfo<CL_PROFILING_COMMAND_END>() -
                                       sort.done.getProfilingInfo<CL_PROFILING_COMMAND_START>())
                      << " ms\n";
        }
    };

    const cl::Buffer& cells = cells_[sort.rest_is_in].cl();
    const Memory longs(device_, sort.rest, sizeof(cellist_sort_long), "long lists");
    const std::uint64_t owners_end = storage.capacity_nodes() / tuning.slots + sort.rest;
    const Memory owners(device_, owners_end, sizeof(cl_uint), "owners of chunks");
    const std::uint64_t part_count =
        linked ? (storage.capacity_nodes() >> part_bits) + sort.rest : 0;
    const Memory parts(device_, part_count, sizeof(cl_uint2), "parts of lists");
    Memory places(device_, part_count, sizeof(cl_uint2), "places of parts of lists");
    const Range walks =
        Range::padded((part_count + tuning.lists - 1) / tuning.lists, in_groups() ? 64 : 16);

    Arguments place = arguments_of(storage, cells, sort.rest, longs.cl(), owners.cl(),
                                   static_cast<cl_uint>(owners_end), state_.cl());
    if (linked) {
        constexpr cl_uint none = CELLIST_NONE;
        places.fill(&none, sizeof none, places.size_bytes());
        run("cellist_sort_measure", walks, arguments_of(storage, cells, sort.rest, parts.cl()));
        place.add(parts.cl());
        place.add(places.cl());
        place.add(spare->heads.cl());
    }
    run("cellist_sort_place", Range::padded(sort.rest, 64), place);
    if (linked)
        run("cellist_sort_collect", walks,
            arguments_of(storage, cells, sort.rest, longs.cl(), parts.cl(), places.cl(),
                         spare->nodes.cl()));
    read_state(sort);
    if (linked) adopt(sort);

    const cl_uint chunks = sort.state.chunks;
    const cl::Buffer* from = &storage.nodes();
    const cl::Buffer* to = &spare->nodes.cl();
    run("cellist_sort_chunks",
        Range::padded(std::uint64_t{chunks} * tuning.items, tuning.items == 1 ? 16 : tuning.items),
        arguments_of(longs.cl(), owners.cl(), chunks, *from));
    const unsigned shares = std::max(tuning.slots / tuning.share, 1u);
    for (std::uint64_t nodes = tuning.slots; nodes < sort.state.longest; nodes *= 2) {
        run("cellist_sort_merge",
            Range::padded(std::uint64_t{chunks} * shares, in_groups() ? 128 : 16),
            arguments_of(longs.cl(), owners.cl(), chunks, *from, *to,
                         static_cast<cl_uint>(nodes)));
        std::swap(from, to);
    }
    run("cellist_sort_return", Range::padded(std::uint64_t{chunks} * tuning.slots),
        arguments_of(longs.cl(), owners.cl(), chunks, spare->nodes.cl(), storage.nodes()));
}

/// Puts the lists that have moved in the place of those that have not.
void ListSorter::adopt(Sort& sort) {
    ListStorage& storage = sort.storage;
    if (sort.state.nodes != storage.stored())
        throw Error("lists cannot be sorted: they have " + std::to_string(sort.state.nodes) +
                    " nodes instead of " + std::to_string(storage.stored()) +
                    " (Lists::validate() finds why); the lists are as they were");
    if (storage.stored() < storage.capacity_nodes())
        sort.done = kernel("cellist_sort_allocate", kernels::sort_long_cl, sort.key, long_tuning())
                        .enqueue(Range::padded(1u << CELLIST_SHARD_BITS_MAX),
                                 arguments_of(storage, static_cast<cl_uint>(storage.stored())));
    storage.exchange_spare();
}

}  // namespace cellist::detail
