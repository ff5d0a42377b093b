#pragma once

#include <span>
#include <string>
#include <string_view>

namespace support {

/// " (did you mean 'gearworks'?)" for the name that differs least from `text`: by inserted, left-out,
/// changed and swapped characters, for a third of it at most. Nothing where no name is as close.
[[nodiscard]] std::string did_you_mean(std::string_view text, std::span<const std::string> names);

}  // namespace support
