// The nearest layers of each pixel in slots, and nothing of the others: Quality::layers of them, or 8.
#include "list_method.hpp"

namespace oit {
namespace {

constexpr std::uint32_t default_slots = 8;

std::unique_ptr<Method> make(FragmentSource& source) {
    return make_list_method(source, {.storage = cellist::Storage::fixed,
                                     .overflow = cellist::Overflow::keep_nearest,
                                     .slots = source.frame().quality.layers.value_or(default_slots),
                                     .nearest_by = "key"});
}

const MethodRegistration kbuffer(
    {.name = "kbuffer",
     .summary = "the 8 nearest layers, or as many as asked for (Bavoil et al. 2007)",
     .position = 7,
     .exact = false,
     .refusal = refuses_nothing,
     .make = make});

}  // namespace
}  // namespace oit
