// SPDX-License-Identifier: MIT
#pragma once

#include <cellist/detail/memory.hpp>

namespace cellist::detail {

/// Allocates anew unless the memory has room for `count` elements on this device.
inline void reserve(Memory& memory, const std::shared_ptr<DeviceState>& device, std::uint64_t count,
                    std::size_t element_bytes, const char* what) {
    if (memory.cl()() == nullptr || memory.size_bytes() < count * element_bytes ||
        memory.device() != device)
        memory = Memory(device, count, element_bytes, what);
}

}  // namespace cellist::detail
