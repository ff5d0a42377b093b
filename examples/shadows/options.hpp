// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "camera.hpp"
#include "frame.hpp"
#include "picture_name.hpp"
#include "scene.hpp"

namespace shadows {

/// What the command line asks for.
struct Options {
    std::string scene = "room";  ///< room, swarm, or a mesh file
    std::size_t triangles = 100'000;
    bool parallel_light = false;
    std::optional<glm::dvec3> light_position;
    Settings settings;
    std::optional<support::Orbit> view;  ///< else as the scene says
    double zoom = 1;
    std::uint32_t frames = 5;
    double time = 0;          ///< of the first frame, in seconds
    double time_step = 0.04;  ///< in seconds
    support::PictureName out{"shadows.png"};
    std::filesystem::path out_unblocked, out_a, out_b, heatmap, out_error, json;
    bool reference = false;
    bool trade = false;
    std::string device;
    std::vector<std::string> arguments;
    [[nodiscard]] bool writes_to_stdout() const;
    std::string help_text;  ///< to print instead, if it is not empty
};

/// Throws InputError, with one line, if the command line is invalid.
[[nodiscard]] Options parse_options(int count, const char* const* arguments);

/// The scene at its first frame. Throws InputError if it is neither a scene nor a mesh file.
[[nodiscard]] Scene make_scene(const Options& options);

}  // namespace shadows
