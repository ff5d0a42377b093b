// SPDX-License-Identifier: MIT
#pragma once

// What tests reach that users do not: the division of sorts, the tuner, and what a device is.
#include <cellist/lists.hpp>

#include "device/device_state.hpp"
#include "sort/sort.hpp"
#include "tune/automatic.hpp"

namespace cellist::test {

/// The device of the tests, which counts as a GPU of eight compute units, whatever it is.
[[nodiscard]] inline Device like_gpu() {
    Device device = Device::choose();
    DeviceInfo& info = device.state()->info;
    info.type = CL_DEVICE_TYPE_GPU;
    info.one_thread_per_work_group = false;
    info.compute_units = 8;
    return device;
}

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
