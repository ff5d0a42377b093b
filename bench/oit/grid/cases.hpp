// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "frame_options.hpp"

namespace oit {

/// A view of a scene, and its budgets. Each budget is a case.
struct GridView {
    std::string name;
    std::string scene;      ///< its name, or a mesh file
    std::string arguments;  ///< further ones of cellist-oit
    std::array<std::string, 3> budgets;
};

/// The ten views of the grid, with the meshes in a folder.
[[nodiscard]] std::vector<GridView> grid_views(const std::filesystem::path& meshes);

/// A view of any mesh.
[[nodiscard]] GridView view_of_mesh(const std::filesystem::path& mesh);

/// Reads the arguments. Throws InputError where they cannot be used.
[[nodiscard]] FrameOptions frame_options(const GridView& view);

/// Whether it is drawn from a file.
[[nodiscard]] bool is_of_mesh(const GridView& view);

}  // namespace oit
