#include "sweep.hpp"

#include <algorithm>
#include <filesystem>

namespace oit {
namespace {

bool is_named(std::string_view method, std::span<const std::string_view> methods) {
    return std::ranges::find(methods, method) != methods.end();
}

double accuracy(const Measurement& measurement) {
    return std::min(measurement.comparison.psnr_db, psnr_enough);
}

bool beats(const Measurement& a, const Measurement& b) {
    return a.drawn() && a.milliseconds <= b.milliseconds && accuracy(a) >= accuracy(b) &&
           (a.milliseconds < b.milliseconds || accuracy(a) > accuracy(b));
}

// All fragments, stored as floats.
bool gives_nothing_up(const Measurement& measurement) {
    const auto& [method, quality] = measurement.setting;
    return measurement.drawn() && method->exact && quality == exact_setting(quality).quality;
}

const Measurement* all_layers(const Sweep& sweep) {
    for (const Measurement& measurement : sweep.measurements)
        if (gives_nothing_up(measurement) &&
            measurement.setting.method == exact_setting(measurement.setting.quality).method)
            return &measurement;
    return nullptr;
}

}  // namespace

std::string Sweep::scene_name() const {
    return std::filesystem::path(options.scene).filename().string();
}

std::vector<Setting> settings_of(const Frame& frame, std::uint64_t most_layers,
                                 std::span<const std::string_view> methods) {
    std::vector<Setting> settings = settings_for(frame, most_layers);
    std::erase_if(settings,
                  [&](const Setting& setting) { return !is_named(setting.method->name, methods); });
    return settings;
}

std::vector<LeftOut> left_out(const Frame& frame, std::span<const std::string_view> names) {
    std::vector<LeftOut> result;
    for (const MethodInfo& method : methods()) {
        if (!is_named(method.name, names)) continue;
        const std::string reason = method.refusal(frame, needs_of(frame));
        if (!reason.empty()) result.push_back({method.name, reason});
    }
    return result;
}

std::vector<bool> pareto_front(std::span<const Measurement> measurements) {
    std::vector<bool> front;
    for (const Measurement& own : measurements)
        front.push_back(own.drawn() &&
                        std::ranges::none_of(measurements, [&](const Measurement& other) {
                            return beats(other, own);
                        }));
    return front;
}

std::vector<Relation> fewer_layers(const Sweep& sweep) {
    std::vector<Relation> result;
    const Measurement* all = all_layers(sweep);
    if (all == nullptr) return result;
    for (const Measurement& measurement : sweep.measurements)
        if (measurement.drawn() && measurement.setting.quality.layers)
            result.push_back({&measurement, all->milliseconds / measurement.milliseconds});
    std::ranges::sort(result, {}, [](const Relation& relation) {
        return *relation.measurement->setting.quality.layers;
    });
    return result;
}

std::vector<Relation> exact_methods(const Sweep& sweep) {
    std::vector<Relation> result;
    const Measurement* all = all_layers(sweep);
    if (all == nullptr) return result;
    for (const Measurement& measurement : sweep.measurements)
        if (gives_nothing_up(measurement))
            result.push_back({&measurement, measurement.milliseconds / all->milliseconds});
    return result;
}

}  // namespace oit
