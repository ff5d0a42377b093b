#pragma once

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

class ListsCore;

/// What lists are sorted by.
struct SortKey {
    std::string expression;  ///< of `record`
    unsigned bits;           ///< 32 or 64, what its values need
    Order order;
};

/// Sorts the lists of a container. Lists are sorted in classes by their length: up to some hundred nodes by
/// ranking, a few work-items a list; longer ones by all work-items together. A kernel is compiled when
/// the first list of its class is met.
class ListSorter {
public:
    ListSorter(std::shared_ptr<DeviceState> device, Definitions definitions);

    /// Completes when all lists are sorted. Blocks until it is known which classes there are, unless
    /// no list can be longer than those of the first class.
    cl::Event sort(const ListsCore& lists, const SortKey& key);

private:
    /// How a class of lists is sorted; see sort.cl and sort_lists.cl.
    struct Class {
        unsigned slots;  ///< longest list
        unsigned width;  ///< records that a work-item ranks at once
        unsigned team;   ///< work-items that sort a list
        unsigned items;  ///< work-items that sort together
        unsigned lists;  ///< lists that they sort
    };
    /// Lists that are left to be sorted.
    struct Rest {
        Memory cells;
        cl_uint count;
    };

    [[nodiscard]] std::vector<Class> classes() const;
    [[nodiscard]] bool groups() const { return (device_->info.type & CL_DEVICE_TYPE_GPU) != 0; }
    [[nodiscard]] cellist_sort_state read_state();
    cl::Event sort_class(const ListsCore& lists, const SortKey& key, const Class& what,
                         const Rest* listed, const Memory& longer, cl_uint capacity);
    cl::Event sort_long(const ListsCore& lists, const SortKey& key, const Class& what,
                        const Rest& rest);
    cl::Event sort_in_place(const ListsCore& lists, const SortKey& key, const Class& what,
                            const cl::Buffer& cells, cl_uint count);
    Kernel& kernel(const char* name, std::string_view source, const SortKey& key,
                   const Class& what);

    std::shared_ptr<DeviceState> device_;
    Definitions definitions_;
    Memory state_;
    std::map<std::string, Kernel> kernels_;  ///< by name and what it is compiled with
};

}  // namespace cellist::detail
