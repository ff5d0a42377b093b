// SPDX-License-Identifier: MIT
// Depth of field from the nearest layers of each pixel, found by depth peeling. The scene is drawn
// once for each layer, and once before the first.
#include <array>

#include "methods/lens_gather.hpp"
#include "methods/peeling_common.hpp"

namespace oit {
namespace {

constexpr std::array layer_counts{1U, 2U, 4U, 8U, 16U};
constexpr std::uint32_t default_layers = 4;

class Peeled : public Method {
public:
    explicit Peeled(FragmentSource& source)
        : source_(source),
          pixels_(static_cast<cl_uint>(source.frame().pixels())),
          layers_(source.frame().quality.size.value_or(default_layers)),
          pass_(source.pass(peeling_text(kernels::peeled_cl), "peeled.cl")),
          advance_(
              source.screen_kernel(peeling_text(kernels::peeled_cl), "peeled.cl", "oit_advance")),
          current_(source.device(), pixels_),
          next_(source.device(), pixels_),
          nodes_(source.device(), std::size_t{source.layout().words} * layers_ * pixels_),
          counts_(source.device(), pixels_),
          lens_(source, peeling_text(kernels::peeled_cl)) {}

    void store() override {
        current_.fill(first_key);
        next_.fill(last_key);
        counts_.fill(0);
        // The first pass keeps nothing, and finds the first layer.
        for (cl_uint pass = 0; pass <= layers_; ++pass) {
            const cl_uint first = pass > 0 ? (pass - 1) * pixels_ : 0;
            source_.draw(pass_, current_, next_, nodes_, first);
            source_.run_on_screen(advance_, current_, next_, counts_);
        }
    }

    void resolve() override { lens_.run(nodes_, counts_, pixels_); }
    [[nodiscard]] bool finish_or_grow() override { return lens_.finish_or_grow(); }

    [[nodiscard]] std::uint64_t device_bytes() const override {
        return raster::bytes_of(current_, next_, nodes_, counts_) + lens_.device_bytes();
    }

private:
    FragmentSource& source_;
    cl_uint pixels_;
    cl_uint layers_;
    raster::Pass pass_;
    cellist::Kernel advance_;
    cellist::Buffer<cl_ulong> current_;
    cellist::Buffer<cl_ulong> next_;
    cellist::Buffer<cl_uint> nodes_;
    cellist::Buffer<cl_uint> counts_;
    LensGather lens_;
};

std::string peeled_refusal(const Frame& frame, const FrameFeatures& features) {
    if (frame.lens && frame.quality.layers)
        return "its size is the number of layers: leave out --layers";
    return refuses_pinholes(frame, features);
}

const MethodRegistration peeled_method(
    {.name = "peeled",
     .summary = "rays through the nearest layers, 4 by default, from depth peeling (Lee et al. "
                "2010)",
     .position = 180,
     .exact = false,
     .sizes = layer_counts,
     .refusal = peeled_refusal,
     .make = make_peeling<Peeled>,
     .passes = [](const SurveyResult&, const Quality& quality) -> std::uint64_t {
         return quality.size.value_or(default_layers) + 1;
     }});

}  // namespace
}  // namespace oit
