// SPDX-License-Identifier: MIT
#include "methods/accumulating.hpp"

#include "input_error.hpp"
#include "oit_kernels.hpp"

namespace oit {

std::string accumulating_text(std::string_view source) {
    return std::string(kernels::accumulate_clh).append("\n").append(source);
}

std::string accumulating_refusal(const Frame& frame, const FrameFeatures& features) {
    if (std::string needed = needs_all_fragments(frame); !needed.empty()) return needed;
    if (features.blends != 0 && features.blends != 1U << static_cast<std::uint32_t>(Blend::over))
        return "it supports only surfaces that cover what is behind them";
    if (frame.quality.depth_range) return "it has no depth for each sample";
    if (frame.quality.layers) return "it blends all layers at once";
    return {};
}

void require_wide_sums(const cellist::Device& device) {
    if (!device.info().int64_atomics)
        throw support::InputError("adding up fragments needs 64-bit atomic operations, which " +
                                  device.info().name + " does not have");
}

AccumulatingMethod::AccumulatingMethod(FragmentSource& source)
    : source_(source),
      sums_(source.device(), 5 * source.samples()),
      resolve_(
          source.screen_kernel(kernels::accumulate_clh, "accumulate.clh", "oit_resolve_sums")) {}

}  // namespace oit
