// SPDX-License-Identifier: MIT
#include "oit/frames/run.hpp"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <utility>

#include "input_error.hpp"
#include "scene/scenes.hpp"

namespace bench {
namespace {

std::regex regex_of(const std::string& text) try {
    return std::regex(text);
} catch (const std::regex_error&) {
    throw support::InputError("--filter " + text + ": expected a regular expression");
}

oit::Scene scene_of(const oit::FrameOptions& options) {
    oit::Scene scene = oit::make_scene(options);
    oit::stand_on_floor(scene, options);
    return scene;
}

int scaled(int side, double factor) {
    return std::max(1, static_cast<int>(std::lround(factor * side)));
}

}  // namespace

Case mesh_case(const std::string& file) {
    Case result{.name = std::filesystem::path(file).stem().string(), .options = {}};
    result.options.scene = file;
    result.options.width = result.options.height = 512;
    return result;
}

Case scene_case(const std::string& name) {
    Case result{.name = name, .options = {}};
    result.options.scene = name;
    return result;
}

Case gearworks_of_most_layers() {
    return with(scene_case("gearworks"), "64 layers", [](oit::FrameOptions& options) {
        options.orbit = {.azimuth_degrees = 50, .elevation_degrees = -45};
        options.time = 0.9;
    });
}

Case with(Case original, const std::string& what,
          const std::function<void(oit::FrameOptions& options)>& change) {
    original.name += ", " + what;
    change(original.options);
    return original;
}

Stage::Stage(const oit::FrameOptions& options)
    : scene(scene_of(options)), frame(oit::make_frame(scene, options)) {}

Run::Run(const cellist::Device& device, const RunOptions& options)
    : device_(device), options_(options), filter_(regex_of(options.filter)) {}

void Run::measure(const std::string& section, std::span<const Case> cases,
                  const std::function<std::vector<Row>(const Stage& stage)>& measure) {
    for (const auto& [name, asked] : cases) {
        const std::string title = section + "/" + name;
        if (!std::regex_search(title, filter_)) continue;
        oit::FrameOptions options = asked;
        options.width = scaled(options.width, options_.size);
        options.height = scaled(options.height, options_.size);
        if (oit::find_scene(options.scene) == nullptr) {
            const std::filesystem::path mesh = options_.meshes / options.scene;
            if (!std::filesystem::exists(mesh)) {
                leave_out(title, mesh.string() + " is missing: --meshes names its folder");
                continue;
            }
            options.scene = mesh.string();
        }
        try {
            const Stage stage(options);
            for (const Row& measured : measure(stage)) {
                Row row{{"case", name},
                        {"width", options.width},
                        {"height", options.height},
                        {"triangles", stage.scene.triangles()}};
                row.update(measured);
                std::cerr << title << ' ' << measured << '\n';
                rows_[section].push_back(std::move(row));
            }
        } catch (const std::exception& error) {
            leave_out(title, error.what());
        }
    }
}

void Run::leave_out(const std::string& what, const std::string& reason) {
    std::cerr << what << " is left out: " << reason << '\n';
    rows_["left_out"].push_back({{"what", what}, {"reason", reason}});
}

std::vector<Samples> Run::draw_interleaved(
    std::span<const std::function<double()>> drawings) const {
    const auto round = [&] {
        std::vector<double> seconds;
        for (const std::function<double()>& draw : drawings) seconds.push_back(1e-3 * draw());
        return seconds;
    };
    return sample({.least = options_.frames, .most = options_.frames}, round);
}

Run::Row to_json(const Samples& times) {
    return {{"ms", 1e3 * times.median},
            {"least_ms", 1e3 * times.least},
            {"greatest_ms", 1e3 * times.greatest},
            {"frames", times.count}};
}

}  // namespace bench
