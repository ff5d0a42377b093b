// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

#include <cellist/cellist.hpp>

#include "device_types.hpp"
#include "scene.hpp"
#include "sweep.hpp"

namespace motion {

/// Samples of each pixel that are drawn at once; more are drawn in batches.
constexpr std::size_t batch_samples = 64;

constexpr std::uint64_t no_budget = std::numeric_limits<std::uint64_t>::max();

struct Settings {
    int width = 1024;
    int height = 768;
    int shadow_map = 1024;       ///< texels along each axis
    cl_uint samples = 20;        ///< of each pixel
    bool prepass = true;         ///< only texels that shadow tests will read
    bool insides = false;        ///< of closed surfaces, too, in the shadow map
    cl_float bias = 1.0F;        ///< of shadow tests, in texels
    bool compress = false;       ///< merge ranges, and leave out hidden ones
    cl_float tolerance = 0.25F;  ///< of the depth of merged ranges, in texels
    /// The memory of the lists of ranges. With a limit, they are built in slices.
    std::uint64_t budget_bytes = no_budget;
    /// The storage of the lists; without it, the fastest on the device.
    std::optional<cellist::Storage> storage = {};
};

/// What the passes of a picture share.
struct Frame {
    Frame(const cellist::Device& device, const Scene& scene, const Settings& settings);

    /// Projects the vertices into both views. Does not block.
    void project();

    [[nodiscard]] std::size_t pixels() const;
    [[nodiscard]] cellist::Storage storage() const;
    [[nodiscard]] std::size_t texels() const { return farthest.size(); }

    const cellist::Device& device;
    Settings settings;
    SceneBuffers scene;
    SeenScene camera, light;
    Shading shading;
    cellist::Buffer<cl_ulong> keys;       ///< what the camera sees at a batch of samples
    cellist::Buffer<Receiver> receivers;  ///< of a batch of samples: see visible.cl
    /// For each texel: what is farther from the light than this blocks nothing.
    cellist::Buffer<cl_float> farthest;
    cellist::Kernel project_vertices;
};

/// The shadow test of a method: `pass` is its text, see test.clh.
class ShadowTest {
public:
    template <class... Uses>
    ShadowTest(const cellist::Device& device, std::string_view pass, const Uses&... uses)
        : kernel_(moving_kernel(device, text_of(pass), "test_samples", uses...)) {}

    /// Marks the samples of a batch that are in shadow, if their texel is one of `texels` from
    /// `first_texel` on. `targets` are the arguments of the pass. Does not block.
    template <class... Targets>
    void run(const Frame& f, const Sampling& batch, std::size_t first_texel, std::size_t texels,
             const Targets&... targets) {
        kernel_.run(cellist::Range{f.pixels(), batch.count}, targets..., f.light.view,
                    f.light.vertices, f.scene.indices, batch, static_cast<cl_uint>(f.pixels()),
                    static_cast<cl_uint>(first_texel), static_cast<cl_uint>(texels), f.receivers);
    }

private:
    [[nodiscard]] static std::string text_of(std::string_view pass);
    cellist::Kernel kernel_;
};

/// The text of a kernel, after keys.clh and receiver.clh.
[[nodiscard]] std::string with_receivers(std::string_view text);

}  // namespace motion
