#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>

#include <cellist/detail/memory.hpp>
#include <cellist/detail/record_type.hpp>
#include <cellist/kernel.hpp>
#include <cellist/options.hpp>

#include "device_state.hpp"
#include "view.hpp"

namespace cellist::detail {

class ListStorage;

/// What lists are sorted by.
struct SortKey {
    std::string expression;  ///< of `record`
    unsigned bits;           ///< 32 or 64: what its values need
    Order order;
};

/// Sorts the lists of a container in classes by their length: up to some hundred nodes by ranking, each
/// list on its own; longer ones by all work-items together. Kernels are compiled when a list needs them.
class ListSorter {
public:
    ListSorter(std::shared_ptr<DeviceState> device, Definitions definitions);

    /// Sorts all lists; `least` nodes of each at least, the others may follow in any order. The event
    /// completes when that is done. Blocks until it is known how long the lists are. Throws Error where
    /// links lead in circles. Whatever fails, lists hold what they held, in some order.
    cl::Event sort(ListStorage& storage, const SortKey& key, std::uint32_t least);

    /// Divides the work from now on as on a device of this type; for tests.
    void set_device_type(cl_device_type type) { device_type_ = type; }

private:
    /// How work is divided; see the kernels.
    struct Tuning {
        unsigned slots;      ///< records that are ranked together
        unsigned width;      ///< records that a work-item ranks at once
        unsigned items;      ///< work-items that sort together
        unsigned team;       ///< work-items that sort a list
        unsigned lists;      ///< lists that `items` sort, or parts of lists that a work-item walks
        unsigned share = 1;  ///< nodes that a work-item merges
        unsigned least = 1;  ///< most records that a work-item brings to the front
    };
    /// A sort that is under way.
    struct Sort {
        ListStorage& storage;
        const SortKey& key;
        cl::Event done = {};      ///< of the last command
        cl_uint rest = 0;         ///< lists that are left
        unsigned rest_is_in = 0;  ///< which of cells_ has them
        cellist_sort_state state = {};
    };

    [[nodiscard]] bool in_groups() const { return (device_type_ & CL_DEVICE_TYPE_GPU) != 0; }
    [[nodiscard]] std::size_t record_bytes() const { return definitions_.records.back().size; }
    [[nodiscard]] Tuning class_tuning(std::size_t index, bool linked) const;
    [[nodiscard]] std::size_t first_class(const ListStorage& storage) const;
    [[nodiscard]] Tuning long_tuning() const;

    bool bring_to_front(Sort& sort, std::uint32_t least);
    void sort_in_place(Sort& sort, bool listed);
    void sort_classes(Sort& sort);
    void sort_class(Sort& sort, const Tuning& tuning, bool listed, cl_uint stage);
    void sort_long(Sort& sort);
    void adopt(Sort& sort);
    void clear_state();
    void read_state(Sort& sort);
    Kernel& kernel(const char* name, std::string_view source, const SortKey& key,
                   const Tuning& tuning);

    std::shared_ptr<DeviceState> device_;
    Definitions definitions_;
    cl_device_type device_type_;
    Memory state_;
    std::array<Memory, 2> cells_;            ///< whose lists are left to be sorted
    std::map<std::string, Kernel> kernels_;  ///< by name, mode and source
    std::array<cl_uint, CELLIST_SORT_LENGTHS> lengths_{};  ///< lists of the last sort by their class
};

}  // namespace cellist::detail
