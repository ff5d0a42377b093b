// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace oit {

/// What the command line of cellist-budget-grid asks for.
struct GridOptions {
    int width = 320;
    int height = 180;
    std::vector<std::filesystem::path> files = {};  ///< meshes to draw instead of the grid
    std::filesystem::path meshes = {};
    std::string filter = {};   ///< in the names of the views to draw
    std::uint32_t frames = 7;  ///< of each setting that are timed, at least
    double cost = 1.1;         ///< of the chosen setting, in costs of the best one, at most
    std::filesystem::path json = {};
    std::string git = {};  ///< the commit that the results name
    std::string device = {};
    std::string help_text = {};  ///< to be printed instead, where it is not empty
};

/// Reads and checks the command line. Throws InputError where an argument cannot be used.
[[nodiscard]] GridOptions parse_grid_options(int count, const char* const* arguments);

}  // namespace oit
