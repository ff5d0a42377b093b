// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>
#include <string>

#include <glm/vec3.hpp>

#include "camera.hpp"

namespace support {

class CommandLine;

/// "25,8": azimuth and elevation.
[[nodiscard]] std::string view_text(const Orbit& orbit);

/// Reads the same, with a zoom of 1. Throws InputError, which begins with --view, where the text is
/// anything else.
[[nodiscard]] Orbit read_view(const std::string& text);

/// --view AZIMUTH,ELEVATION. An empty default is not read.
void add_view(CommandLine& line, const std::string& usual, std::function<void(const Orbit&)> read);

/// --zoom Z
void add_zoom(CommandLine& line, double& zoom);

/// Where --view and --zoom move the camera of a scene.
[[nodiscard]] glm::dvec3 moved_eye(const glm::dvec3& eye, const glm::dvec3& target,
                                   const std::optional<Orbit>& view, double zoom);

}  // namespace support
