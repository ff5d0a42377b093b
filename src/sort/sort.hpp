// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <cellist/detail/lists_core.hpp>
#include <cellist/detail/memory.hpp>
#include <cellist/kernel.hpp>

#include "device/device_state.hpp"
#include "device/record_kernels.hpp"
#include "device/view.hpp"
#include "sort/key.hpp"
#include "sort/sort_tuning.hpp"
#include "storage/storage.hpp"

namespace cellist::detail {

/// Sorts the lists of a container in classes by their length: up to some hundred nodes by ranking,
/// each list on its own; longer ones by all work-items together. Kernels are compiled when a list
/// needs them.
class ListSorter {
public:
    ListSorter(MemoryOwner device, RecordKernels& kernels);

    /// Sorts all lists, the first `top_k` nodes of each at least: the others may follow in any
    /// order. Blocks until it is known how long the lists are. During Device::prepare, also runs
    /// the kernels that lists of other lengths need. Throws Error where links or offsets
    /// are corrupt. Whatever fails, sound lists keep their records, in some order.
    cl::Event sort(ListStorage& storage, const SortKey& key, std::uint32_t top_k);
    /// Sorts all lists in place, one work-item a list. Does not block.
    cl::Event sort_in_place(ListStorage& storage, const SortKey& key);

    /// Divides the work from now on as on a device of this type; for tests.
    void set_device_type(cl_device_type type) { device_type_ = type; }

private:
    /// A sort that is under way.
    struct Sort {
        ListStorage& storage;
        const SortKey& key;
        SortPlan plan;
        bool linked;
        ExpressionProgram program;
        std::string definitions;    ///< for all kernels of this sort, except the program of the key
        std::uint64_t count;        ///< lists that are left
        const Memory* cells = {};   ///< whose lists these are; null for all
        bool is_rehearsal = false;  ///< runs for no list
        cl::Event done = {};        ///< of the last command
        cellist_sort_state state = {};
    };

    [[nodiscard]] Sort sort_of(ListStorage& storage, const SortKey& key) const;
    bool select_top_k(Sort& sort, std::uint32_t top_k);
    [[nodiscard]] static std::pair<const cl::Buffer&, cl_uint> cells_of(const Sort& sort);
    void sort_in_place(Sort& sort);
    SortTuning sort_classes(Sort& sort);
    void sort_class(Sort& sort, const SortTuning& tuning, cl_uint stage);
    void sort_long(Sort& sort, const SortTuning& class_tuning);
    void rehearse(Sort& sort);
    /// The keys of long lists, where their values must be kept: one buffer goes with the pool, the
    /// other with its back buffer.
    struct Keys {
        Memory of_pool;
        Memory of_back_buffer;
    };
    void merge(Sort& sort, const Memory& long_lists, const Memory& chunk_owners, const Keys& keys);
    [[nodiscard]] std::optional<Keys> keys_of(const Sort& sort) const;
    [[nodiscard]] bool has_room_for(const Sort& sort, std::uint64_t more_bytes) const;
    void run_long(Sort& sort, const char* name, const Range& range, const Arguments& arguments);
    void swap_pools(Sort& sort, const SortTuning& tuning);
    [[nodiscard]] std::size_t first_class(const Sort& sort) const;
    [[nodiscard]] std::uint64_t most_left(const Sort& sort, const SortTuning& tuning) const;

    [[nodiscard]] bool make_state(const Sort& sort);
    void clear_state();
    void read_state(Sort& sort) const;
    void check_nodes(const Sort& sort) const;
    Kernel& kernel(const KernelFile& file, const char* name, const Sort& sort,
                   const SortTuning& tuning);

    MemoryOwner device_;
    RecordKernels& kernels_;
    cl_device_type device_type_;
    Memory state_;                 ///< none before the first sort that has room for it
    std::array<Memory, 2> cells_;  ///< whose lists each class leaves, alternating
    std::array<cl_uint, CELLIST_SORT_CLASSES> in_class_{};  ///< lists of the last sort
};

}  // namespace cellist::detail
