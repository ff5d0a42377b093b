// SPDX-License-Identifier: MIT
// How much light reaches a depth is kept as a function of a few steps.
#include <array>

#include "methods/accumulating.hpp"
#include "methods/lists.hpp"
#include "oit_kernels.hpp"

namespace oit {
namespace {

constexpr std::array adaptive_sizes{2U, 4U, 8U, 16U, 32U};
constexpr std::uint32_t default_steps = 8;

std::unique_ptr<Method> make_adaptive(FragmentSource& source) {
    const std::uint32_t steps = source.frame().quality.size.value_or(default_steps);
    return make_list_method(source, {.storage = cellist::Storage::linked},
                            ListReader{define("OIT_STEPS", steps).append(kernels::adaptive_cl),
                                       "adaptive.cl", "oit_resolve_adaptive"});
}

const MethodRegistration adaptive_method(
    {.name = "adaptive",
     .summary = "transmittance as a step function, 8 steps by default (Salvi et al. 2011)",
     .position = 110,
     .exact = false,
     .sizes = adaptive_sizes,
     .refusal = accumulating_refusal,
     .make = make_adaptive});

}  // namespace
}  // namespace oit
