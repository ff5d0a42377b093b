// SPDX-License-Identifier: MIT
#pragma once

#include <stdexcept>

namespace support {

/// What the user gave cannot be used. The message names the value and the limit.
class InputError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

}  // namespace support
