// SPDX-License-Identifier: MIT
#pragma once

#include <concepts>
#include <memory>
#include <string>
#include <utility>

namespace viewer {

/// The scene that was loaded last, so that both sides of a split view share it.
template <class Scene>
class SceneCache {
public:
    /// The scene of this key: the last one, or what `load` returns.
    std::shared_ptr<const Scene> get(const std::string& key, std::invocable auto&& load) {
        if (!scene_ || key != key_) {
            scene_.reset();
            scene_ = std::make_shared<const Scene>(load());
            key_ = key;
        }
        return scene_;
    }

private:
    std::string key_;
    std::shared_ptr<const Scene> scene_;
};

}  // namespace viewer
