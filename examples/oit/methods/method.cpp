// SPDX-License-Identifier: MIT
#include "methods/method.hpp"

#include <algorithm>

#include "closest.hpp"
#include "input_error.hpp"

namespace oit {
namespace {

std::vector<MethodInfo>& method_table() {
    static std::vector<MethodInfo> methods;
    return methods;
}

}  // namespace

MethodRegistration::MethodRegistration(const MethodInfo& info) {
    std::vector<MethodInfo>& methods = method_table();
    const auto after = std::find_if(methods.begin(), methods.end(), [&](const MethodInfo& other) {
        return other.position > info.position;
    });
    methods.insert(after, info);
}

std::span<const MethodInfo> methods() { return method_table(); }

const MethodInfo& method_named(std::string_view name) {
    std::string list;
    std::vector<std::string> names;
    for (const MethodInfo& info : method_table()) {
        if (info.name == name) return info;
        list.append(list.empty() ? "" : ", ").append(info.name);
        names.emplace_back(info.name);
    }
    throw support::InputError("there is no method '" + std::string(name) + "'" +
                              support::did_you_mean(name, names) + "; the methods are " + list);
}

std::uint32_t read_size_of(const MethodInfo& method, const std::string& text) {
    std::string known;
    for (const std::uint32_t size : method.sizes) {
        if (std::to_string(size) == text) return size;
        known += (known.empty() ? "" : ", ") + std::to_string(size);
    }
    const std::string name(method.name);
    throw support::InputError("the method " + name + " has no size '" + text +
                              (known.empty() ? "': it has no sizes" : "': the sizes are " + known));
}

std::optional<PictureError> no_bound(const SurveyResult&, const Quality&) { return {}; }

std::optional<PictureError> bound_of_layers(const SurveyResult& scene, const Quality& quality) {
    const bool all = !quality.layers || *quality.layers >= scene.longest;
    if (all && quality.epsilon == 0) return scene.format(quality.format);
    if (quality.format != NodeFormat::float32) return {};
    if (!all && quality.epsilon > 0) return {};
    const SurveyResult::Cut* cut =
        all ? scene.epsilon_cut(quality.epsilon) : scene.layers_cut(*quality.layers);
    if (cut == nullptr) return {};
    return cut->error;
}

std::uint64_t one_pass(const SurveyResult&, const Quality&) { return 1; }

std::uint64_t two_passes(const SurveyResult&, const Quality&) { return 2; }

std::string needs_all_fragments(const Frame& frame) {
    if (frame.lens) return "a lens needs a list of layers for each pixel";
    if (frame.quality.coverage == Coverage::exact)
        return "exact coverage needs all triangles of each pixel";
    return {};
}

std::string refuses_pinholes(const Frame& frame, const FrameFeatures&) {
    return frame.lens ? "" : "it draws through a lens only: add --lens";
}

}  // namespace oit
