// A linked list for each pixel, in one pass.
#include "methods/list_method.hpp"

namespace oit {
namespace {

std::unique_ptr<Method> make(FragmentSource& source) {
    return make_list_method(source, {.storage = cellist::Storage::linked});
}

const MethodRegistration linked({.name = "linked",
                                 .summary = "a linked list for each pixel (Yang et al. 2010)",
                                 .position = 10,
                                 .exact = true,
                                 .cuts = true,
                                 .refusal = refuses_nothing,
                                 .make = make,
                                 .bound = bound_of_layers});

}  // namespace
}  // namespace oit
