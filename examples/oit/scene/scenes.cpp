// SPDX-License-Identifier: MIT
#include "scene/scenes.hpp"

#include <algorithm>
#include <vector>

namespace oit {
namespace {

std::vector<SceneInfo>& scene_table() {
    static std::vector<SceneInfo> scenes;
    return scenes;
}

}  // namespace

SceneRegistration::SceneRegistration(const SceneInfo& info) {
    std::vector<SceneInfo>& scenes = scene_table();
    const auto after = std::find_if(scenes.begin(), scenes.end(),
                                    [&](const SceneInfo& other) { return other.name > info.name; });
    scenes.insert(after, info);
}

std::span<const SceneInfo> scenes() { return scene_table(); }

const SceneInfo* find_scene(std::string_view name) {
    for (const SceneInfo& info : scene_table())
        if (info.name == name) return &info;
    return nullptr;
}

}  // namespace oit
