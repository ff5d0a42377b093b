// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "frame_options.hpp"
#include "methods/method.hpp"

namespace oit {

/// What the command line of cellist-tradeoff asks for.
struct TradeoffOptions : FrameOptions {
    std::vector<std::string_view> methods;  ///< names, by position in the table
    std::uint32_t frames = 6;               ///< of each setting that are timed
    std::filesystem::path heatmap = {};
    std::filesystem::path json = {};
    std::filesystem::path csv = {};
    std::filesystem::path html = {};
    /// A file goes to stdout, so that the table goes to stderr.
    [[nodiscard]] bool writes_to_stdout() const;

    std::string help_text = {};  ///< to be printed instead, where it is not empty
};

/// Reads and checks the command line, the paths of the output among it. Throws InputError where an
/// argument cannot be used.
[[nodiscard]] TradeoffOptions parse_tradeoff_options(int count, const char* const* arguments);

}  // namespace oit
