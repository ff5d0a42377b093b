// SPDX-License-Identifier: MIT
#include "frame/blend_function.hpp"

#include <string_view>

#include "input_error.hpp"
#include "oit_kernels.hpp"

namespace oit {
namespace {

// Calls the function as blend.clh does.
constexpr std::string_view caller = R"(
kernel void oit_check_blend(global float3* out) {
    OitFragment fragment = {1.0f, (float3)(0.5f), 0.5f, OIT_USER, 1};
    float3 colour = out[0], transmittance = out[1];
    blend(&fragment, 0.0f, &colour, &transmittance);
    out[0] = colour;
    out[1] = transmittance;
}
)";

// The first line of a compiler's log that speaks of an error.
std::string first_error(const std::string& log) {
    std::size_t at = log.find("error");
    if (at == std::string::npos) at = 0;
    const std::size_t before = log.rfind('\n', at);
    const std::size_t begin = before == std::string::npos ? 0 : before + 1;
    return log.substr(begin, log.find('\n', at) - begin);
}

}  // namespace

std::string blend_function_text(const std::optional<BlendFunction>& function) {
    if (!function) return {};
    return "#line 1 \"" + function->file_name + "\"\n" + function->text +
           "\n#line 1 \"blend.clh\"\n";
}

void check_blend_function(const cellist::Device& device, const std::string& defines,
                          const BlendFunction& function) {
    const cellist::Source source{.text = "#define OIT_NO_NODES\n" + defines +
                                         std::string(kernels::fragment_clh) +
                                         blend_function_text(function) + std::string(caller),
                                 .file_name = function.file_name};
    try {
        const cellist::Kernel kernel(device, source, "oit_check_blend");
    } catch (const cellist::OpenClError& error) {
        throw support::InputError("the blend function of '" + function.file_name +
                                  "' does not compile: " + first_error(error.log()));
    }
}

}  // namespace oit
