// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdio>
#include <string>

#include <cellist/device.hpp>

namespace bench {

/// The PCI bus address of a device, as CUDA writes it; empty if unknown.
[[nodiscard]] inline std::string bus_of(const cellist::Device& device) {
    const cl::Device opencl = device.queue().getInfo<CL_QUEUE_DEVICE>();
    cl_device_pci_bus_info_khr at{};
    if (clGetDeviceInfo(opencl(), CL_DEVICE_PCI_BUS_INFO_KHR, sizeof(at), &at, nullptr) !=
        CL_SUCCESS)
        return {};
    std::array<char, 48> text{};
    std::snprintf(text.data(), text.size(), "%04x:%02x:%02x.%x", at.pci_domain, at.pci_bus,
                  at.pci_device, at.pci_function);
    return text.data();
}

}  // namespace bench
