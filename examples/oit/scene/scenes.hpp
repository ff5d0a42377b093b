// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "scene/scene.hpp"

namespace oit {

/// A scene that is computed; each has a place in a file here, which puts it into the table.
struct SceneInfo {
    std::string_view name;
    std::string_view summary;  ///< what it shows, in one line
    /// `alpha` is the opacity of its surfaces, where the scene does not say itself.
    Scene (*make)(float alpha);
    bool takes_alpha =
        true;  ///< else all surfaces have opacities of their own, and --alpha is refused
};

/// Puts a scene into the table: a constant in the scene's file.
class SceneRegistration {
public:
    explicit SceneRegistration(const SceneInfo& info);
};

/// All scenes, by name.
[[nodiscard]] std::span<const SceneInfo> scenes();

/// The scene of this name, or nothing.
[[nodiscard]] const SceneInfo* find_scene(std::string_view name);

}  // namespace oit
