// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "camera.hpp"
#include "frame.hpp"
#include "scene.hpp"

namespace motion {

/// What the command line asks for.
struct Options {
    std::string scene = "cubes";  ///< cubes, walker, fan, blinds, or a mesh file
    std::size_t triangles = 265'000;
    RigidMotion motion;  ///< of a mesh
    bool parallel_light = false;
    double exposure = 1;                 ///< the part of the motion that the shutter sees
    std::optional<support::Orbit> view;  ///< else as the scene says
    double zoom = 1;
    Settings settings;
    std::string method = "exact";  ///< or "all"
    cl_uint moments = 3000;        ///< of the reference
    std::uint32_t frames = 5;
    std::filesystem::path out{"motion-shadows.png"};
    std::filesystem::path out_shadow, out_difference, out_reference, json, csv, html;
    bool reference = false;
    bool trade = false;
    std::string device;
    std::vector<std::string> arguments;
    [[nodiscard]] bool writes_to_stdout() const;
    /// Whether the command line asks for pictures of this method.
    [[nodiscard]] bool shows(std::string_view name) const;
    std::string help_text;  ///< to print instead, if it is not empty
};

/// Throws InputError, with one line, if the command line is invalid.
[[nodiscard]] Options parse_options(int count, const char* const* arguments);

/// Throws InputError if the name is neither a scene nor a mesh file.
[[nodiscard]] Scene make_scene(const Options& options);

}  // namespace motion
