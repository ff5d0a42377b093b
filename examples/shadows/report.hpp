// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <iosfwd>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "options.hpp"
#include "reference.hpp"

namespace shadows {

/// What drawing some frames told.
struct FrameReport {
    Options options;
    std::string device, driver;
    std::vector<double> frames_ms;
    std::vector<std::pair<std::string, double>> passes_ms;
    FrameCounts counts;
    cellist::Lengths lengths;
    grid::GridCells cells{};
    std::uint64_t scene_triangles = 0, blockers = 0;
    std::uint64_t device_bytes = 0;
    std::optional<std::uint64_t> most_passed;  ///< entries that a ray from the eye passes
    std::optional<Accuracy> accuracy;
};

void print(std::ostream& out, const FrameReport& report);

/// docs/shadows.md has a table of the keys.
[[nodiscard]] nlohmann::ordered_json to_json(const FrameReport& report);

/// What both JSON reports begin with: the program, the scene and the device.
[[nodiscard]] nlohmann::ordered_json scene_json(const Options& options, const std::string& device,
                                                const std::string& driver);
[[nodiscard]] nlohmann::ordered_json settings_json(const Settings& settings);

}  // namespace shadows
