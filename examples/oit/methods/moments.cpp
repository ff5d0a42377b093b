// SPDX-License-Identifier: MIT
// How much light reaches a depth is found from four moments of the absorbance in front.
#include "methods/accumulating.hpp"
#include "oit_kernels.hpp"

namespace oit {
namespace {

std::string moments_source(const std::string& defines = {}) {
    return defines + accumulating_text(kernels::moments_cl);
}

class Moments : public AccumulatingMethod {
public:
    explicit Moments(FragmentSource& source)
        : AccumulatingMethod(source),
          sum_moments_(source.pass(moments_source("#define OIT_MOMENTS\n"), "moments.cl")),
          add_(source.pass(moments_source(), "moments.cl")),
          moments_(source.device(), 5 * source.samples()),
          nearest_(source.device(), source.samples()) {}

    void store() override {
        moments_.fill(0);
        nearest_.fill(infinity_bits);
        sums_.fill(0);
        source_.draw(sum_moments_, moments_, nearest_);
        source_.draw(add_, moments_, nearest_, sums_);
    }
    [[nodiscard]] std::uint64_t device_bytes() const override {
        return AccumulatingMethod::device_bytes() + raster::bytes_of(moments_, nearest_);
    }

private:
    raster::Pass sum_moments_;
    raster::Pass add_;
    cellist::Buffer<cl_long> moments_;
    cellist::Buffer<cl_uint> nearest_;
};

const MethodRegistration moments_method(
    {.name = "moments",
     .summary = "transmittance from four moments of depth (Muenstermann et al. 2018)",
     .position = 100,
     .exact = false,
     .has_nodes = false,
     .refusal = accumulating_refusal,
     .make = make_accumulating<Moments>,
     .passes = two_passes});

}  // namespace
}  // namespace oit
