// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <iosfwd>
#include <optional>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "budget/measurement.hpp"
#include "mesh.hpp"
#include "methods/renderer.hpp"
#include "options.hpp"
#include "reference/comparison.hpp"
#include "report/choice_report.hpp"

namespace oit {

/// What a run measured.
struct Report {
    Options options;
    std::string device;
    std::string driver;
    std::uint64_t triangles = 0;
    std::vector<SceneMesh> meshes;            ///< the files of the picture
    support::MeshDrops drops;                 ///< of all of them
    std::optional<cellist::Lengths> lengths;  ///< of methods that keep all fragments
    std::optional<std::uint64_t> node_bytes;  ///< of a fragment, without links, where it has a node
    std::uint64_t method_bytes = 0;           ///< what the method keeps on the device
    std::uint64_t device_bytes = 0;
    std::uint64_t peak_bytes = 0;  ///< of the process in main memory, at most until now
    bool blends_slices = false;    ///< as soon as each is built: the passes are not timed apart
    std::uint32_t slices = 1;      ///< that the frame was built in
    std::uint64_t pixels_nan = 0;
    float colour_max = 1;                  ///< brightest channel of a fragment, at most
    Measurement times{.setting = {}};      ///< of frames: from clearing to the image on the device
    PassTimes passes;                      ///< medians
    std::optional<Comparison> comparison;  ///< with all layers
    std::size_t reference_views = 0;       ///< as reference_views(): pictures, or 0
    std::optional<Comparison>
        nearest_comparison;        ///< with Quality::layers, where there is a number
    std::optional<Choice> choice;  ///< for a budget
    BudgetRecord record;
};

/// One screen for people.
void print(const Report& report, std::ostream& out);

/// The same and more, as docs/json.md says. What is infinite or was not measured is null.
[[nodiscard]] nlohmann::ordered_json to_json(const Report& report);

}  // namespace oit
