#pragma once

#include <string>
#include <string_view>

namespace support {

/// Of a message, for where there is one line for it.
[[nodiscard]] inline std::string first_line(std::string_view text) {
    return std::string(text.substr(0, text.find('\n')));
}

}  // namespace support
