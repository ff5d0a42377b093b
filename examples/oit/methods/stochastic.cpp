// SPDX-License-Identifier: MIT
// Fragments hide each other at random, in a number of trials.
#include <array>

#include "methods/accumulating.hpp"
#include "oit_kernels.hpp"

namespace oit {
namespace {

constexpr std::array stochastic_sizes{2U, 4U, 8U, 16U, 32U, 64U};
constexpr std::uint32_t default_trials = 8;

std::uint32_t trials_of(const FragmentSource& source) {
    return source.frame().quality.size.value_or(default_trials);
}

std::string stochastic_source(const FragmentSource& source, const std::string& defines = {}) {
    return defines + define("OIT_TRIALS", trials_of(source)) +
           accumulating_text(kernels::stochastic_cl);
}

class Stochastic : public AccumulatingMethod {
public:
    explicit Stochastic(FragmentSource& source)
        : AccumulatingMethod(source),
          hide_(source.pass(stochastic_source(source, "#define OIT_HIDE\n"), "stochastic.cl")),
          add_(source.pass(stochastic_source(source), "stochastic.cl")),
          depths_(source.device(), trials_of(source) * source.samples()) {}

    void store() override {
        depths_.fill(infinity_bits);
        sums_.fill(0);
        source_.draw(hide_, depths_);
        source_.draw(add_, depths_, sums_);
    }
    [[nodiscard]] std::uint64_t device_bytes() const override {
        return AccumulatingMethod::device_bytes() + raster::bytes_of(depths_);
    }

private:
    raster::Pass hide_;
    raster::Pass add_;
    cellist::Buffer<cl_uint> depths_;
};

const MethodRegistration stochastic_method(
    {.name = "stochastic",
     .summary = "random trials of visibility, 8 by default (Enderton et al. 2010)",
     .position = 90,
     .exact = false,
     .has_nodes = false,
     .sizes = stochastic_sizes,
     .refusal = accumulating_refusal,
     .make = make_accumulating<Stochastic>,
     .passes = two_passes});

}  // namespace
}  // namespace oit
