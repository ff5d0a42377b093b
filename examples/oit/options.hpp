#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "frame_options.hpp"

namespace oit {

/// What the command line asks for.
struct Options : FrameOptions {
    std::string method = "linked";
    bool reference = false;
    std::filesystem::path out = "oit.png";
    std::filesystem::path json = {};
    std::uint32_t frames = 5;
    bool help = false;
    std::string help_text = {};
};

/// Reads and checks the command line, and the file of a blend function. Throws InputError where an
/// argument cannot be used.
[[nodiscard]] Options parse_options(int count, const char* const* arguments);

}  // namespace oit
