// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <cellist/cellist.hpp>

#include "camera.hpp"
#include "files.hpp"
#include "frame/frame.hpp"
#include "mesh.hpp"

namespace support {
class CommandLine;
}

namespace oit {

/// What is drawn, from where, and on which device: the options that all programs which draw have.
struct FrameOptions {
    std::string scene;  ///< the name of a computed scene, or a mesh file as MESH[:ALPHA]
    std::vector<std::string> more_meshes = {};  ///< further mesh files, as MESH[:ALPHA]
    int width = 1280;
    int height = 720;
    float alpha = 0.35F;
    support::Orbit orbit{.azimuth_degrees = 25, .elevation_degrees = 8};
    std::optional<double> eye_separation = {};  ///< for two eyes
    double time = 0;                            ///< of the scene, in seconds
    bool opaque_floor = false;
    std::optional<Lens> lens = {};
    std::optional<support::UpAxis> up = {};  ///< of mesh files; else what each file says, or y
    Quality quality = {};
    bool all_samples = false;         ///< 1, 2, 4 and 8 samples and exact coverage, to compare them
    std::optional<Blend> blend = {};  ///< of all transparent surfaces; else the scene decides
    std::optional<BlendFunction> blend_function = {};
    std::string device = {};
    std::vector<std::string> arguments = {};  ///< of the program, for its report
};

/// Adds these options to a command line, which reads and checks them: options whose argument cannot
/// be used, or has no effect, throw InputError. Refers to both until the line is parsed.
void add_frame_options(support::CommandLine& line, FrameOptions& options);

/// The text of --blend; empty where the scene decides.
[[nodiscard]] std::string blend_text(const FrameOptions& options);

/// support::check_outputs() with the files that the options read.
void check_outputs(const FrameOptions& options, std::span<const support::NamedFile> outputs);

/// For the end of a help text: all methods and scenes.
[[nodiscard]] std::string help_on_tables();

/// Throws InputError where the device cannot hold an image of the options' size.
void check_size(const FrameOptions& options, const cellist::Device& device);

/// The device that the options ask for, or Device::choose(). Throws InputError where it cannot hold
/// an image of their size.
[[nodiscard]] cellist::Device choose_device(const FrameOptions& options);

/// A mesh file of a command line: MESH[:ALPHA]. If the whole argument is the name of a file, the
/// text after its last colon is not an opacity.
struct MeshFile {
    std::filesystem::path path;
    std::optional<float> alpha;
};
[[nodiscard]] MeshFile mesh_file(const std::string& text);

/// A title for the picture: file names without folders, or the scene's name.
[[nodiscard]] std::string title_of(const FrameOptions& options);

/// The scene without a floor, from files or computed. Throws InputError where there is neither a
/// file nor a scene of this name, a file holds no mesh, or the options ask for a time and nothing
/// moves.
[[nodiscard]] Scene make_scene(const FrameOptions& options);

/// Whether the options ask for a floor, and an eye is above it: from below, it would hide the
/// scene.
[[nodiscard]] bool sees_floor(const Scene& scene, const FrameOptions& options);

/// Adds this floor.
void stand_on_floor(Scene& scene, const FrameOptions& options);

/// Whether time changes something in the scene.
[[nodiscard]] bool moves(const Scene& scene);

/// Throws InputError, which begins with `option`, where time changes nothing in the scene.
void require_motion(const Scene& scene, const FrameOptions& options, const std::string& option);

/// What the eyes see.
[[nodiscard]] std::vector<raster::View> make_views(const FrameOptions& options);

/// The frame of a scene, which must outlive it.
[[nodiscard]] Frame make_frame(const Scene& scene, const FrameOptions& options);

}  // namespace oit
