// An array of equal length for each pixel, in one pass.
#include "methods/list_method.hpp"

namespace oit {
namespace {

std::unique_ptr<Method> make(FragmentSource& source) {
    return make_list_method(source, {.storage = cellist::Storage::fixed});
}

const MethodRegistration fixed(
    {.name = "fixed",
     .summary = "fixed slots for each pixel, up to the longest list (FreePipe, Liu et al. 2010)",
     .position = 30,
     .exact = true,
     .refusal = refuses_nothing,
     .make = make,
     .bound = bound_of_layers});

}  // namespace
}  // namespace oit
