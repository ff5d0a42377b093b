#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>

#include <cellist/cellist.hpp>

#include "device_types.hpp"
#include "scene.hpp"
#include "sweep.hpp"

namespace motion {

constexpr std::uint64_t no_budget = std::numeric_limits<std::uint64_t>::max();

struct Settings {
    int width = 1024;
    int height = 768;
    int shadow_map = 1024;    ///< texels along each axis
    cl_uint samples = 20;     ///< of each pixel
    bool prepass = true;      ///< only texels that shadow tests will read
    cl_float bias = 1.0F;     ///< of shadow tests, in texels
    bool compress = true;     ///< of Method::exact: merge ranges, and leave out hidden ones
    cl_float tolerance = 0.25F;  ///< of the depth of merged ranges, in texels
    /// Of the lists of ranges, which are then built in slices.
    std::uint64_t budget_bytes = no_budget;
    cellist::Storage storage = cellist::Storage::linked;
};

/// What the passes of a picture share.
struct Frame {
    Frame(const cellist::Device& device, const Scene& scene, const Settings& settings);

    [[nodiscard]] std::size_t pixels() const;
    [[nodiscard]] std::size_t texels() const { return wanted.size(); }

    const cellist::Device& device;
    Settings settings;
    SceneBuffers scene;
    SeenScene camera, light;
    Shading shading;
    cellist::Buffer<cl_uint> hits;     ///< of a batch of samples: see visible.cl
    cellist::Buffer<cl_uchar> wanted;  ///< texels that shadow tests read
};

/// A kernel over samples that takes what Receiver needs.
class SampleKernel {
public:
    template <class... Uses>
    SampleKernel(const cellist::Device& device, std::string_view pass, const std::string& name,
                 const Uses&... uses)
        : kernel_(moving_kernel(device, text_of(pass), name, uses...)) {}

    /// `before` and `after` are the arguments around those of RECEIVER_SCENE. Does not block.
    template <class... Before, class... After>
    void run(const Frame& f, const cellist::Range& range, const std::tuple<const Before&...>& before,
             const After&... after) {
        std::apply(
            [&](const Before&... first) {
                kernel_.run(range, first..., f.camera.view, f.camera.vertices, f.light.view,
                            f.light.vertices, f.scene.indices, f.scene.begin, f.scene.end,
                            f.shading, after...);
            },
            before);
    }

private:
    [[nodiscard]] static std::string text_of(std::string_view pass);
    cellist::Kernel kernel_;
};

/// The shadow test of a method: `pass` is its text, see test.clh.
class ShadowTest {
public:
    template <class... Uses>
    ShadowTest(const cellist::Device& device, std::string_view pass, const Uses&... uses)
        : kernel_(device, pass, "test_samples", uses...) {}

    /// Marks the hits of a batch that are in shadow, of those whose texel is one of `texels` from
    /// `first_texel` on. `targets` are the arguments of the pass. Does not block.
    template <class... Targets>
    void run(const Frame& f, const Sampling& batch, std::size_t first_texel, std::size_t texels,
             const Targets&... targets) {
        kernel_.run(f, cellist::Range{f.pixels(), batch.count}, std::tie(targets...), batch,
                    static_cast<cl_uint>(first_texel), static_cast<cl_uint>(texels), f.hits);
    }

private:
    SampleKernel kernel_;
};

}  // namespace motion
