// How much light reaches a depth is kept as a function of a few steps.
#include "accumulating.hpp"
#include "list_method.hpp"
#include "oit_kernels.hpp"

namespace oit {
namespace {

constexpr int steps = 8;

std::unique_ptr<Method> make(FragmentSource& source) {
    return make_list_method(source, {.storage = cellist::Storage::linked},
                            ListReader{"#define OIT_STEPS " + std::to_string(steps) + "\n" +
                                           std::string(kernels::adaptive_cl),
                                       "adaptive.cl", "oit_resolve_adaptive"});
}

const MethodRegistration adaptive(
    {.name = "adaptive",
     .summary = "transmittance as a function of 8 steps (Salvi et al. 2011)",
     .position = 11,
     .exact = false,
     .refusal = accumulating_refusal,
     .make = make});

}  // namespace
}  // namespace oit
