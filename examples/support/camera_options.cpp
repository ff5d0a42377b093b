// SPDX-License-Identifier: MIT
#include "camera_options.hpp"

#include <charconv>
#include <cmath>
#include <string_view>

#include <glm/geometric.hpp>

#include "command_line.hpp"
#include "input_error.hpp"
#include "number_text.hpp"

namespace support {
namespace {

std::optional<double> finite_number(std::string_view text) {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
        return {};
    return value;
}

}  // namespace

std::string view_text(const Orbit& orbit) {
    return shortest(orbit.azimuth_degrees) + "," + shortest(orbit.elevation_degrees);
}

Orbit read_view(const std::string& text) {
    const std::size_t comma = text.find(',');
    const auto azimuth = finite_number(std::string_view(text).substr(0, comma));
    const auto elevation = comma == std::string::npos
                               ? std::nullopt
                               : finite_number(std::string_view(text).substr(comma + 1));
    if (!azimuth || !elevation)
        refuse("--view", text, "AZIMUTH,ELEVATION in degrees, such as 25,8");
    if (std::abs(*elevation) > 90)
        throw InputError("--view " + text + ": the elevation must be from -90 to 90");
    return {.azimuth_degrees = std::fmod(*azimuth, 360.0), .elevation_degrees = *elevation};
}

void add_view(CommandLine& line, const std::string& usual, std::function<void(const Orbit&)> read) {
    line.add("--view", usual, "direction to look from, in degrees", "AZIMUTH,ELEVATION",
             [read = std::move(read)](const std::string& text) { read(read_view(text)); });
}

void add_zoom(CommandLine& line, double& zoom) {
    line.add_real("--zoom", zoom, 0.01, 100, "divide the distance of the camera by this", "Z");
}

glm::dvec3 moved_eye(const glm::dvec3& eye, const glm::dvec3& target,
                     const std::optional<Orbit>& view, double zoom) {
    if (!view && zoom == 1) return eye;
    Orbit orbit = view.value_or(orbit_of(eye, target));
    orbit.zoom = zoom;
    return eye_on(orbit, target, glm::length(eye - target));
}

}  // namespace support
