// SPDX-License-Identifier: MIT
#include "methods/peeling_common.hpp"

#include "input_error.hpp"
#include "oit_kernels.hpp"

namespace oit {

std::string peeling_text(std::string_view source) {
    return std::string(kernels::peeling_common_clh).append("\n").append(source);
}

std::string peeling_refusal(const Frame& frame, const FrameFeatures&) {
    if (std::string needed = needs_all_fragments(frame); !needed.empty()) return needed;
    if (frame.quality.depth_range) return "it has no depth for each sample";
    if (frame.quality.samples > 1 && frame.quality.resolve == Resolve::per_sample)
        return "it resolves samples by pixel";
    return {};
}

void require_wide_atomics(const cellist::Device& device, std::string_view what) {
    for (const cl::Device& one : device.context().getInfo<CL_CONTEXT_DEVICES>())
        if (one.getInfo<CL_DEVICE_EXTENSIONS>().find("cl_khr_int64_extended_atomics") ==
            std::string::npos)
            throw support::InputError(std::string(what) +
                                      " needs 64-bit atomic operations, which " +
                                      device.info().name + " does not have");
}

}  // namespace oit
