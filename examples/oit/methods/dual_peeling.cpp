// SPDX-License-Identifier: MIT
// The scene is drawn once for every two layers, and takes the nearest and the farthest that are
// left.
#include "methods/peeling_common.hpp"
#include "oit_kernels.hpp"

namespace oit {
namespace {

// A pair of keys, in front and behind.
struct Keys {
    cl_ulong front, back;
};

std::string dual_peeling_refusal(const Frame& frame, const FrameFeatures& features) {
    if (features.has(Blend::absorb) || features.has(Blend::user))
        return "it blends from both sides and does not know the distances between layers";
    if (frame.quality.layers) return "it takes the farthest layers together with the nearest";
    return peeling_refusal(frame, features);
}

class DualPeeling : public Method {
public:
    explicit DualPeeling(FragmentSource& source)
        : source_(source),
          pass_(source.pass(peeling_text(kernels::dual_peeling_cl), "dual_peeling.cl")),
          peel_(source.screen_kernel(peeling_text(kernels::dual_peeling_cl), "dual_peeling.cl",
                                     "oit_peel")),
          finish_(source.screen_kernel(peeling_text(kernels::dual_peeling_cl), "dual_peeling.cl",
                                       "oit_finish_dual_peeling")),
          current_(source.device(), source.frame().pixels()),
          next_(source.device(), source.frame().pixels()),
          nodes_(source.device(), 2 * source.layout().words * source.frame().pixels()),
          front_(source.device(), source.state_floats() * source.frame().pixels()),
          back_(source.device(), front_.size()),
          left_(source.device(), 1) {}

    void store() override {
        current_.fill({first_key, last_key});
        next_.fill({last_key, first_key});
        // The first pass takes nothing, and finds the first and the last layer.
        do {
            left_.fill(0);
            source_.draw(pass_, current_.cl(), next_.cl(), nodes_);
            source_.run_on_screen(peel_, current_.cl(), next_.cl(), nodes_, front_, back_, left_);
        } while (left_.download().front() != 0);
    }

    void resolve() override { source_.run_on_screen(finish_, front_, back_); }

    [[nodiscard]] std::uint64_t device_bytes() const override {
        return raster::bytes_of(current_, next_, nodes_, front_, back_);
    }

private:
    FragmentSource& source_;
    raster::Pass pass_;
    cellist::Kernel peel_;
    cellist::Kernel finish_;
    cellist::Buffer<Keys> current_;
    cellist::Buffer<Keys> next_;
    cellist::Buffer<cl_uint> nodes_;
    cellist::Buffer<cl_float> front_;
    cellist::Buffer<cl_float> back_;
    cellist::Buffer<cl_uint> left_;
};

// The first takes no layer.
std::uint64_t dual_peeling_passes(const SurveyResult& scene, const Quality&) {
    return (scene.longest + 1) / 2 + 1;
}

const MethodRegistration dual_peeling_method(
    {.name = "dual_peeling",
     .summary = "the nearest and the farthest layer in each pass (Bavoil, Myers 2008)",
     .position = 50,
     .exact = true,
     .refusal = dual_peeling_refusal,
     .make = make_peeling<DualPeeling>,
     .bound = bound_of_layers,
     .passes = dual_peeling_passes});

}  // namespace
}  // namespace oit
