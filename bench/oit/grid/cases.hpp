#pragma once

#include <array>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "frame_options.hpp"

namespace oit {

/// A scene as it is seen from somewhere, and the budgets within which it is drawn: a case each.
struct GridView {
    std::string_view name;
    std::string_view arguments;  ///< of cellist-oit; meshes are named without their folder
    std::array<std::string_view, 3> budgets;
};

[[nodiscard]] std::span<const GridView> grid_views();

/// Reads the arguments. Meshes are files in `meshes`. Throws InputError where they cannot be used.
[[nodiscard]] FrameOptions frame_options(const GridView& view, const std::filesystem::path& meshes);

/// Whether it is drawn from a file.
[[nodiscard]] bool is_of_mesh(const GridView& view);

}  // namespace oit
