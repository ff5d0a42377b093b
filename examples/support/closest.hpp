// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace support {

/// " (did you mean 'gearworks'?)" for the name that differs least from `text`, counted in inserted,
/// left-out, changed and swapped characters. Empty if every name differs in more than a third.
[[nodiscard]] std::string did_you_mean(std::string_view text, std::span<const std::string> names);

}  // namespace support
