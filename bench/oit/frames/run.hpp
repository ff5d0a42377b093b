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

/// A frame to draw: a scene of the example or a mesh, and how.
struct Case {
    std::string name;
    oit::FrameOptions options;
};

/// A mesh of the folder with meshes, at 512 x 512 as in Yang et al. 2010.
[[nodiscard]] Case mesh_case(const std::string& file);
/// A scene of the example's table, at 1280 x 720.
[[nodiscard]] Case scene_case(const std::string& name);
/// gearworks from the view, and at the time, where a pixel has the most layers: 64 at 1280 x 720.
[[nodiscard]] Case gearworks_of_most_layers();
/// The same, drawn otherwise.
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

/// What is measured in one run on a device.
class Run {
public:
    using Figure = nlohmann::ordered_json;

    /// Refers to the device. Throws InputError where the filter is no regular expression.
    Run(const cellist::Device& device, const RunOptions& options);

    /// A section: the figures that measure(stage) has of each case that is asked for. Cases without
    /// their mesh and cases that fail are left out.
    void measure(const std::string& section, std::span<const Case> cases,
                 const std::function<std::vector<Figure>(const Stage& stage)>& measure);

    /// Notes what cannot be measured, and why.
    void leave_out(const std::string& what, const std::string& reason);

    /// The times of drawings that are warmed up, each of which returns its milliseconds. They draw
    /// by turns, so that a slow spell of the machine meets all of them.
    [[nodiscard]] std::vector<Samples> draw_by_turns(
        std::span<const std::function<double()>> drawings) const;

    [[nodiscard]] const cellist::Device& device() const { return device_; }
    /// A list of figures for each section, and of what was left out.
    [[nodiscard]] const Figure& figures() const { return figures_; }

private:
    const cellist::Device& device_;
    RunOptions options_;
    std::regex filter_;
    Figure figures_ = Figure::object();
};

/// Milliseconds and number of frames, for a figure.
[[nodiscard]] Run::Figure to_json(const Samples& times);

// The sections.
void measure_frame_times(Run& run);
void measure_exact_methods(Run& run);
void measure_fewer_layers(Run& run);
void measure_plain_cpp(Run& run);
void measure_accuracy(Run& run);

}  // namespace bench
