// SPDX-License-Identifier: MIT
// The nearest layers of each pixel in slots, and nothing of the others: as many as the size
// says, Quality::layers, or 8.
#include <algorithm>
#include <array>

#include "methods/lists.hpp"

namespace oit {
namespace {

constexpr std::array kbuffer_sizes{1U, 2U, 4U, 8U, 16U, 32U, 64U};
constexpr std::uint32_t default_slots = 8;

std::uint32_t slots_of(const Quality& quality) {
    return quality.size.value_or(quality.layers.value_or(default_slots));
}

std::unique_ptr<Method> make_kbuffer(FragmentSource& source) {
    // The records that are not among the nearest are dropped.
    cellist::ListsOptions options{.overflow = cellist::Overflow::drop};
    options.storage = with_node_type(source.layout().words, [&]<class Node>(const Node*) {
        return cellist::nearest(&Node::key, slots_of(source.frame().quality));
    });
    return make_layer_method(source, options);
}

std::string kbuffer_refusal(const Frame& frame, const FrameFeatures&) {
    const Quality& quality = frame.quality;
    if (quality.coverage == Coverage::exact) return needs_all_fragments(frame);
    if (!quality.size || !quality.layers || *quality.layers <= *quality.size) return {};
    return "it keeps " + std::to_string(*quality.size) + " layers, and cannot blend " +
           std::to_string(*quality.layers) + ": leave out its size, or lower --layers";
}

// Its slots hold the nearest layers.
std::optional<PictureError> kbuffer_bound(const SurveyResult& scene, const Quality& quality) {
    Quality nearest = quality;
    nearest.layers = std::min(slots_of(quality), quality.layers.value_or(~0U));
    return bound_of_layers(scene, nearest);
}

const MethodRegistration kbuffer_method(
    {.name = "kbuffer",
     .summary = "the nearest layers, 8 by default (Bavoil et al. 2007)",
     .position = 70,
     .exact = false,
     .sizes = kbuffer_sizes,
     .refusal = kbuffer_refusal,
     .make = make_kbuffer,
     .bound = kbuffer_bound,
     .passes = two_passes});

}  // namespace
}  // namespace oit
