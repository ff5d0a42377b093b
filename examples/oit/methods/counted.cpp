// Contiguous lists: the passes run twice, to count and to fill.
#include "methods/list_method.hpp"

namespace oit {
namespace {

std::unique_ptr<Method> make(FragmentSource& source) {
    return make_list_method(source, {.storage = cellist::Storage::counted});
}

const MethodRegistration counted({.name = "counted",
                                  .summary = "contiguous lists, in two passes (prefix sums)",
                                  .position = 20,
                                  .exact = true,
                                  .refusal = refuses_nothing,
                                  .make = make,
                                  .bound = bound_of_layers,
                                  .passes = two_passes});

}  // namespace
}  // namespace oit
