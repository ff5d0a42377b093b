// SPDX-License-Identifier: MIT
// The scene is drawn once for each layer, and takes the nearest that is behind the last.
#include <algorithm>

#include "methods/peeling_common.hpp"
#include "oit_kernels.hpp"

namespace oit {
namespace {

class Peeling : public Method {
public:
    explicit Peeling(FragmentSource& source)
        : source_(source),
          pass_(source.pass(peeling_text(kernels::peeling_cl), "peeling.cl")),
          peel_(source.screen_kernel(peeling_text(kernels::peeling_cl), "peeling.cl", "oit_peel")),
          finish_(source.screen_kernel(peeling_text(kernels::peeling_cl), "peeling.cl",
                                       "oit_finish_peeling")),
          current_(source.device(), source.frame().pixels()),
          next_(source.device(), source.frame().pixels()),
          nodes_(source.device(), source.layout().words * source.frame().pixels()),
          state_(source.device(), source.state_floats() * source.frame().pixels()),
          left_(source.device(), 1) {}

    void store() override {
        current_.fill(first_key);
        next_.fill(last_key);
        // The first pass takes nothing, and finds the first layer.
        const std::uint64_t passes =
            std::uint64_t{1} + source_.frame().quality.layers.value_or(~0U);
        for (std::uint64_t pass = 0; pass < passes; ++pass) {
            left_.fill(0);
            source_.draw(pass_, current_, next_, nodes_);
            source_.run_on_screen(peel_, current_, next_, nodes_, state_, left_);
            if (left_.download().front() == 0) break;
        }
    }

    void resolve() override { source_.run_on_screen(finish_, state_); }

    [[nodiscard]] std::uint64_t device_bytes() const override {
        return raster::bytes_of(current_, next_, nodes_, state_);
    }

private:
    FragmentSource& source_;
    raster::Pass pass_;
    cellist::Kernel peel_;
    cellist::Kernel finish_;
    cellist::Buffer<cl_ulong> current_;
    cellist::Buffer<cl_ulong> next_;
    cellist::Buffer<cl_uint> nodes_;
    cellist::Buffer<cl_float> state_;
    cellist::Buffer<cl_uint> left_;
};

std::uint64_t peeling_passes(const SurveyResult& scene, const Quality& quality) {
    return std::min<std::uint64_t>(scene.longest, quality.layers.value_or(~0U)) + 1;
}

const MethodRegistration peeling_method(
    {.name = "peeling",
     .summary = "depth peeling: the scene is drawn once for each layer (Everitt 2001)",
     .position = 40,
     .exact = true,
     .refusal = peeling_refusal,
     .make = make_peeling<Peeling>,
     .bound = bound_of_layers,
     .passes = peeling_passes});

}  // namespace
}  // namespace oit
