#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "camera.hpp"

namespace oit {

/// What the command line asks for.
struct Options {
    std::filesystem::path mesh;
    int width = 1280;
    int height = 720;
    float alpha = 0.35F;
    std::optional<std::uint32_t> layers = {};  ///< none means all
    support::Orbit orbit{.azimuth_degrees = 25, .elevation_degrees = 8};
    bool opaque_floor = false;
    bool reference = false;
    std::filesystem::path out = "oit.png";
    std::filesystem::path json = {};
    std::string device = {};
    std::uint32_t frames = 5;
    bool help = false;
    std::string help_text = {};
};

/// Reads and checks the command line. Throws InputError where an argument cannot be used.
[[nodiscard]] Options parse_options(int count, const char* const* arguments);

}  // namespace oit
