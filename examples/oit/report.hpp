#pragma once

#include <cstdint>
#include <filesystem>
#include <iosfwd>
#include <optional>
#include <string>

#include "choice_report.hpp"
#include "comparison.hpp"
#include "mesh.hpp"
#include "options.hpp"
#include "renderer.hpp"

namespace oit {

/// The figures of a run.
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
    bool blends_slices = false;  ///< as soon as each is built: the passes are not timed apart
    std::uint32_t slices = 1;    ///< that the frame was built in
    std::uint64_t pixels_nan = 0;
    float colour_max = 1;                  ///< brightest channel of a fragment, at most
    double frame_ms = 0;                   ///< from clearing to the image on the device, median
    PassTimes passes;                      ///< medians
    std::optional<Comparison> comparison;  ///< with all layers
    std::optional<Comparison>
        nearest_comparison;        ///< with Quality::layers, where there is a number
    std::optional<Choice> choice;  ///< for a budget
    KeptBudget kept;
};

/// One screen for people.
void print(const Report& report, std::ostream& out);

/// The same as JSON. Throws InputError where the file cannot be written.
void write_json(const Report& report, const std::filesystem::path& path);

}  // namespace oit
