// SPDX-License-Identifier: MIT
#pragma once

#include <cellist/device.hpp>

namespace cellist::test {

/// The device that all tests share: Device::choose(). Lives from the start of main to its end.
const Device& device();

}  // namespace cellist::test
