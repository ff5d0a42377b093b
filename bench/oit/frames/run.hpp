// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <regex>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <cellist/cellist.hpp>

#include "frame_options.hpp"
#include "support/timing.hpp"

namespace bench {

/// A frame to draw: a mesh or a scene of the example, and its settings.
struct Case {
    std::string name;
    oit::FrameOptions options;
};

/// A mesh of the folder with meshes, at 512 x 512 as in Yang et al. 2010.
[[nodiscard]] Case mesh_case(const std::string& file);
/// A scene of the example's table, at 1280 x 720.
[[nodiscard]] Case scene_case(const std::string& name);
/// gearworks at the view and time with the most layers in a pixel: 64 at 1280 x 720.
[[nodiscard]] Case gearworks_of_most_layers();
/// The same frame with other settings.
[[nodiscard]] Case with(Case original, const std::string& what,
                        const std::function<void(oit::FrameOptions& options)>& change);

/// A scene and a frame of it.
struct Stage {
    explicit Stage(const oit::FrameOptions& options);
    Stage(const Stage&) = delete;
    Stage& operator=(const Stage&) = delete;

    oit::Scene scene;
    oit::Frame frame;
};

struct RunOptions {
    std::filesystem::path meshes = {};  ///< the folder
    double size = 1;                    ///< factor of the sides of all images
    std::uint32_t frames = 15;          ///< that are timed of each kind
    std::string filter = {};            ///< regular expression of SECTION/CASE
};

/// The measurements of one run on a device.
class Run {
public:
    using Row = nlohmann::ordered_json;

    /// Refers to the device. Throws InputError if the filter is not a regular expression.
    Run(const cellist::Device& device, const RunOptions& options);

    /// Adds a section: measure(stage) gives the rows of each selected case. Cases that fail and
    /// cases without their mesh are left out.
    void measure(const std::string& section, std::span<const Case> cases,
                 const std::function<std::vector<Row>(const Stage& stage)>& measure);

    /// Notes what cannot be measured, and why.
    void leave_out(const std::string& what, const std::string& reason);

    /// The times of drawings after a warm-up. Each drawing returns its milliseconds. They draw
    /// interleaved, so that a slow phase of the machine slows all of them.
    [[nodiscard]] std::vector<Samples> draw_interleaved(
        std::span<const std::function<double()>> drawings) const;

    [[nodiscard]] const cellist::Device& device() const { return device_; }
    /// A list of rows for each section, and a list of what was left out.
    [[nodiscard]] const Row& rows() const { return rows_; }

private:
    const cellist::Device& device_;
    RunOptions options_;
    std::regex filter_;
    Row rows_ = Row::object();
};

/// Milliseconds and number of frames, for a row.
[[nodiscard]] Run::Row to_json(const Samples& times);

// The sections.
void measure_frame_times(Run& run);
void measure_exact_methods(Run& run);
void measure_fewer_layers(Run& run);
void measure_plain_cpp(Run& run);
void measure_accuracy(Run& run);

}  // namespace bench
