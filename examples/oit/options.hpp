#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "camera.hpp"
#include "frame.hpp"

namespace oit {

/// What the command line asks for.
struct Options {
    std::string scene;  ///< a mesh file, or the name of a computed scene
    std::string method = "linked";
    int width = 1280;
    int height = 720;
    float alpha = 0.35F;
    support::Orbit orbit{.azimuth_degrees = 25, .elevation_degrees = 8};
    std::optional<double> eye_separation = {};  ///< for two eyes
    double time = 0;                            ///< of the scene, in seconds
    bool opaque_floor = false;
    Quality quality = {};
    std::optional<std::uint64_t> memory_bytes = {};  ///< that the method may take
    std::optional<Blend> blend = {};  ///< of all transparent surfaces; else the scene decides
    std::optional<BlendFunction> blend_function = {};
    bool reference = false;
    std::filesystem::path out = "oit.png";
    std::filesystem::path json = {};
    std::string device = {};
    std::uint32_t frames = 5;
    bool help = false;
    std::string help_text = {};
};

/// Reads and checks the command line, and the file of a blend function. Throws InputError where an
/// argument cannot be used.
[[nodiscard]] Options parse_options(int count, const char* const* arguments);

}  // namespace oit
