#pragma once

// What tests reach of a container that users do not: the division of sorts, and the tuner.
#include <cellist/lists.hpp>

#include "sort/sort.hpp"
#include "tune/automatic.hpp"

namespace cellist::test {

/// From now on the lists are sorted as on a device of this type.
template <class T>
void sort_as_on(Lists<T>& lists, cl_device_type type) {
    lists.core().sorter().set_device_type(type);
}

/// The tuner of Storage::automatic; null for other storages.
template <class T>
[[nodiscard]] detail::StorageTuner* tuner_of(const Lists<T>& lists) {
    auto* automatic = dynamic_cast<detail::AutomaticStorage*>(&lists.core().storage());
    return automatic == nullptr ? nullptr : &automatic->tuner();
}

}  // namespace cellist::test
