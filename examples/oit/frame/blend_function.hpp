// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include <cellist/cellist.hpp>

#include "frame/frame.hpp"

namespace oit {

/// The function as a part of a program, with its own file name and lines; nothing without one.
[[nodiscard]] std::string blend_function_text(const std::optional<BlendFunction>& function);

/// Throws InputError, with the compiler's first message, unless the function compiles. `defines`
/// are those of the frame.
void check_blend_function(const cellist::Device& device, const std::string& defines,
                          const BlendFunction& function);

}  // namespace oit
