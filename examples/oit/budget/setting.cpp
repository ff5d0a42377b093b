// SPDX-License-Identifier: MIT
#include "budget/setting.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <sstream>
#include <tuple>
#include <utility>

namespace oit {
namespace {

constexpr std::array layer_counts{1U, 2U, 4U, 8U, 16U, 32U, 64U};
constexpr std::array ray_counts{8U, 16U, 32U, 64U, 128U};
constexpr std::array tried_epsilons{0.1F, 0.03F, 0.01F, 0.003F};

}  // namespace

std::string method_text(const Setting& setting) {
    std::string text(setting.method->name);
    if (setting.quality.size) text += ":" + std::to_string(*setting.quality.size);
    return text;
}

std::string text(const Setting& setting) {
    const Quality& quality = setting.quality;
    const Quality usual;
    std::ostringstream out;
    out << "--method " << method_text(setting);
    if (quality.layers) out << " --layers " << *quality.layers;
    if (quality.epsilon > 0) out << " --epsilon " << quality.epsilon;
    if (quality.format != usual.format) out << " --format " << name_of(quality.format);
    if (quality.depth_scale != usual.depth_scale) out << " --depth-scale reversed";
    if (quality.coverage == Coverage::exact)
        out << " --samples exact";
    else if (quality.samples != usual.samples)
        out << " --samples " << quality.samples;
    if (quality.lens_rays != usual.lens_rays) out << " --lens-rays " << quality.lens_rays;
    if (quality.resolve != usual.resolve) out << " --resolve sample";
    if (quality.depth_range) out << " --depth-range";
    return out.str();
}

bool plainer(const Setting& a, const Setting& b) {
    // Less is plainer.
    const auto order = [](const Setting& setting) {
        const Quality& quality = setting.quality;
        return std::tuple(!setting.method->exact, quality.layers || quality.epsilon > 0,
                          quality.format, setting.method->position,
                          -static_cast<std::int64_t>(quality.layers.value_or(~0U)), quality.epsilon,
                          -static_cast<std::int64_t>(quality.size.value_or(0)));
    };
    return order(a) < order(b);
}

Setting exact_setting(const Quality& quality) {
    Setting setting{&method_named("linked"), quality};
    setting.quality.format = NodeFormat::float32;
    setting.quality.layers.reset();
    setting.quality.epsilon = 0;
    setting.quality.size.reset();
    return setting;
}

std::vector<Setting> settings_for(const Frame& frame, std::uint64_t most_layers) {
    const Quality base = exact_setting(frame.quality).quality;
    std::vector<Setting> settings;
    const auto add = [&](const MethodInfo& method, auto Quality::*member, auto value) {
        Quality quality = base;
        quality.*member = value;
        const Setting setting{&method, quality};
        const Frame drawn = with_setting(frame, setting);
        if (method.refusal(drawn, features_of(drawn)).empty()) settings.push_back(setting);
    };
    for (const MethodInfo& method : methods()) {
        if (method.exact)
            for (const NodeFormatName& entry : node_formats)
                add(method, &Quality::format, entry.format);
        else if (method.sizes.empty())
            add(method, &Quality::size, std::nullopt);
        else
            for (const std::uint32_t size : method.sizes) add(method, &Quality::size, size);
        if (!method.cuts) continue;
        // With exact coverage, fragments of one surface share a pixel, so there are no K nearest.
        for (const std::uint32_t layers : layer_counts)
            if (layers < most_layers && base.coverage == Coverage::samples)
                add(method, &Quality::layers, layers);
        if (!frame.lens)
            for (const float epsilon : tried_epsilons) add(method, &Quality::epsilon, epsilon);
        else
            for (const std::uint32_t rays : ray_counts)
                if (rays != base.lens_rays) add(method, &Quality::lens_rays, rays);
    }
    return settings;
}

Frame with_setting(const Frame& frame, const Setting& setting) {
    Frame drawn = frame;
    drawn.quality = setting.quality;
    return drawn;
}

}  // namespace oit
