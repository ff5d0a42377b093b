#include "sort.hpp"

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <iostream>
#include <optional>
#include <sstream>

#include <cellist/detail/lists_core.hpp>

#include "cellist_kernels.hpp"

namespace cellist::detail {

namespace {

std::string define(const char* name, std::uint64_t value) {
    return std::string("#define CELLIST_SORT_") + name + " " + std::to_string(value) + "\n";
}

}  // namespace

ListSorter::ListSorter(std::shared_ptr<DeviceState> device, Definitions definitions)
    : device_(std::move(device)),
      definitions_(std::move(definitions)),
      state_(device_, 1, sizeof(cellist_sort_state), "state of a sort") {}

std::vector<ListSorter::Class> ListSorter::classes() const {
    if (const char* tune = std::getenv("CELLIST_SORT_TUNE")) {
        std::istringstream in(tune);
        std::vector<Class> result;
        Class c{};
        while (in >> c.slots >> c.width >> c.team >> c.items >> c.lists) result.push_back(c);
        return result;
    }
    if (!groups())
        return {{.slots = 256,
                 .width = 8,
                 .team = 1,
                 .items = 1,
                 .lists = definitions_.modes == CELLIST_LINKED ? 32u : 8u}};
    return {{.slots = 32, .width = 8, .team = 4, .items = 128, .lists = 32},
            {.slots = 256, .width = 4, .team = 64, .items = 64, .lists = 1}};
}

Kernel& ListSorter::kernel(const char* name, std::string_view source, const SortKey& key,
                           const Class& what) {
    const std::string type = key.bits == 32 ? "uint" : "ulong";
    const std::string text =
        "#define CELLIST_RECORD " + definitions_.records.back().name + "\n" +
        define("KEY_BITS", key.bits) + define("SLOTS", what.slots) + define("WIDTH", what.width) +
        define("TEAM", what.team) + define("ITEMS", what.items) + define("LISTS", what.lists) +
        define("SHARE", std::getenv("SHARE") ? std::stoul(std::getenv("SHARE")) : what.items == 1 ? 1024 : 8) + "#line 1 \"sort.cl\"\n" +
        std::string(kernels::sort_cl) + "static inline " + type +
        " cellist_sort_key(CELLIST_RECORD record) {\n    return (" + type + ")" +
        (key.order == Order::descending ? "~" : "") +
        "cellist_order(\n#line 1 \"sort expression\"\n" + key.expression + "\n);\n}\n#line 1 \"" +
        name + ".cl\"\n" + std::string(source);
    const std::string id = std::string(name) + "\n" + text;
    if (const auto known = kernels_.find(id); known != kernels_.end()) return known->second;
    return kernels_.emplace(id, Kernel(device_, Source{.text = text}, name, definitions_))
        .first->second;
}

cellist_sort_state ListSorter::read_state() {
    cellist_sort_state state;
    state_.read(&state, sizeof state);
    return state;
}

cl::Event ListSorter::sort_class(const ListsCore& lists, const SortKey& key, const Class& what,
                                 const Rest* listed, const Memory& longer, cl_uint capacity) {
    const std::uint64_t count = listed != nullptr ? listed->count : lists.shape().cells();
    Arguments arguments;
    lists.add_to(arguments);
    arguments.add(listed != nullptr ? listed->cells.cl() : longer.cl());
    arguments.add(cl_uint{listed != nullptr ? 1u : 0u});
    arguments.add(static_cast<cl_uint>(count));
    arguments.add(longer.cl());
    arguments.add(state_.cl());
    arguments.add(capacity);
    const std::uint64_t together = (count + what.lists - 1) / what.lists;
    return kernel("cellist_sort_lists", kernels::sort_lists_cl, key, what)
        .enqueue(Range::padded(together * what.items, what.items == 1 ? 64 : what.items), arguments);
}

cl::Event ListSorter::sort(const ListsCore& lists, const SortKey& key) {
    const std::uint64_t cells = lists.shape().cells();
    std::optional<Rest> rest;
    Class last{};
    for (const Class& what : classes()) {
        last = what;
        constexpr cl_uint zero = 0;
        state_.fill(&zero, sizeof zero, sizeof(cellist_sort_state));
        const std::uint64_t most = std::min(cells, lists.capacity_nodes() / (what.slots + 1) + 1);
        Memory longer(device_, most, sizeof(cl_uint), "cells with longer lists");
        const cl::Event done = sort_class(lists, key, what, rest ? &*rest : nullptr, longer,
                                          static_cast<cl_uint>(most));
        if (lists.capacity_nodes() <= what.slots) return done;
        const cl_uint count = read_state().longer;
        if (count == 0) return done;
        rest = Rest{std::move(longer), std::min(count, static_cast<cl_uint>(most))};
    }
    return sort_long(lists, key, last, *rest);
}

cl::Event ListSorter::sort_long(const ListsCore& lists, const SortKey& key, const Class& what,
                                const Rest& rest) {
    if (const char* slots = std::getenv("SLOTS")) const_cast<Class&>(what).slots = std::stoul(slots);
    const bool linked = definitions_.modes == CELLIST_LINKED;
    const std::uint64_t splitters = linked ? lists.capacity_nodes() >> 9 : 0;
    const std::uint64_t part_count = linked ? splitters + rest.count : 1;
    const std::uint64_t owners_end = lists.capacity_nodes() / what.slots + rest.count;
    Memory parts(device_, part_count, 8, "parts of long lists");
    Memory places(device_, part_count, 8, "places of parts of long lists");
    Memory longs(device_, rest.count, sizeof(cellist_sort_long), "long lists");
    Memory owners(device_, owners_end, sizeof(cl_uint), "owners");
    Memory broken(device_, rest.count, sizeof(cl_uint), "broken lists");
    constexpr cl_uint zero = 0;
    state_.fill(&zero, sizeof zero, sizeof(cellist_sort_state));
    const auto arguments_of = [&](const auto&... values) {
        Arguments arguments;
        lists.add_to(arguments);
        (arguments.add(values), ...);
        return arguments;
    };
    const auto run = [&](const char* name, const Range& range, const Arguments& arguments) {
        const cl::Event e = kernel(name, kernels::sort_long_cl, key, what).enqueue(range, arguments);
        if (std::getenv("TRACE")) {
            e.wait();
            std::cout << "      " << name << " "
                      << 1e-6 * double(e.getProfilingInfo<CL_PROFILING_COMMAND_END>() -
                                       e.getProfilingInfo<CL_PROFILING_COMMAND_START>())
                      << " ms\n";
        }
        return e;
    };
    const Range parts_range =
        Range::padded((part_count + what.lists - 1) / what.lists, what.items == 1 ? 16 : 64);
    const cl_uint none = CELLIST_NONE;
    if (linked) {
        places.fill(&none, sizeof none, places.size_bytes());
        run("cellist_sort_measure", parts_range,
            arguments_of(rest.cells.cl(), rest.count, parts.cl()));
    }
    run("cellist_sort_place", Range::padded(rest.count, 64),
        arguments_of(rest.cells.cl(), rest.count, parts.cl(), places.cl(), longs.cl(), owners.cl(),
                     static_cast<cl_uint>(owners_end), broken.cl(), state_.cl()));
    const cellist_sort_state state = read_state();
    const std::size_t item_bytes =
        linked ? (key.bits == 32 ? 8 : 16) : definitions_.records.back().size;
    Memory scratch(device_, std::uint64_t{state.chunks} * what.slots, item_bytes, "scratch");
    Memory other;
    if (linked)
        other = Memory(device_, std::uint64_t{state.chunks} * what.slots, item_bytes, "scratch");
    const cl::Buffer& second = linked ? other.cl() : scratch.cl();
    if (linked)
        run("cellist_sort_collect", parts_range,
            arguments_of(rest.cells.cl(), rest.count, parts.cl(), places.cl(), longs.cl(),
                         scratch.cl()));
    run("cellist_sort_chunks",
        Range::padded(std::uint64_t{state.chunks} * what.items, what.items == 1 ? 16 : what.items),
        arguments_of(longs.cl(), owners.cl(), state.chunks, scratch.cl()));
    const unsigned share = std::getenv("SHARE") ? unsigned(std::stoul(std::getenv("SHARE"))) : what.items == 1 ? 1024 : 8;
    cl_uint odd = 0;
    for (std::uint64_t run_items = what.slots;
         run_items < std::uint64_t{state.longest_chunks} * what.slots; run_items *= 2) {
        run("cellist_sort_merge",
            Range::padded(std::uint64_t{state.chunks} * std::max(what.slots / share, 1u),
                          what.items == 1 ? 16 : 256),
            arguments_of(longs.cl(), owners.cl(), state.chunks, scratch.cl(), second,
                         static_cast<cl_uint>(run_items), odd));
        odd ^= 1;
    }
    const cl::Event done =
        run("cellist_sort_finish", Range::padded(std::uint64_t{state.chunks} * what.slots),
            arguments_of(longs.cl(), owners.cl(), state.chunks, scratch.cl(), second));
    if (state.broken == 0) return done;
    return sort_in_place(lists, key, what, broken.cl(), state.broken);
}

cl::Event ListSorter::sort_in_place(const ListsCore& lists, const SortKey& key, const Class& what,
                                    const cl::Buffer& cells, cl_uint count) {
    Arguments arguments;
    lists.add_to(arguments);
    arguments.add(cells);
    arguments.add(count);
    return kernel("cellist_sort_in_place", kernels::sort_in_place_cl, key, what)
        .enqueue(Range::padded(count, 64), arguments);
}

}  // namespace cellist::detail
