// SPDX-License-Identifier: MIT
#include "tradeoff/sweep.hpp"

#include <algorithm>
#include <bit>
#include <filesystem>
#include <utility>

#include "stopwatch.hpp"

namespace oit {
namespace {

bool is_named(std::string_view method, std::span<const std::string_view> methods) {
    return std::ranges::find(methods, method) != methods.end();
}

double accuracy(const Measurement& measurement) {
    return std::min(measurement.comparison.psnr_db, psnr_enough);
}

bool beats(const Measurement& a, const Measurement& b) {
    return a.drawn() && !measurably_slower(a.spread_ms(), b.spread_ms()) &&
           accuracy(a) >= accuracy(b) &&
           (measurably_slower(b.spread_ms(), a.spread_ms()) || accuracy(a) > accuracy(b));
}

constexpr std::uint32_t rounds = 3;

// Frames of a round, the first having the most.
std::uint32_t frames_in(std::uint32_t round, std::uint32_t frames) {
    return frames / rounds + (round < frames % rounds ? 1 : 0);
}

// All fragments, stored as floats, and the rays through a lens that were asked for.
bool gives_nothing_up(const Sweep& sweep, const Measurement& measurement) {
    const auto& [method, quality] = measurement.setting;
    return measurement.drawn() && method->exact && quality == exact_setting(quality).quality &&
           quality.lens_rays == sweep.options.quality.lens_rays;
}

// How many times as long `b` takes as `a`.
Relation relation(const Measurement& of, const Measurement& a, const Measurement& b) {
    const Spread x = a.spread_ms(), y = b.spread_ms();
    return {&of, y.median_ms / x.median_ms, y.lower_quartile_ms / x.upper_quartile_ms,
            y.upper_quartile_ms / x.lower_quartile_ms,
            measurably_slower(x, y) || measurably_slower(y, x)};
}

const Measurement* all_layers(const Sweep& sweep) {
    for (const Measurement& measurement : sweep.measurements)
        if (gives_nothing_up(sweep, measurement) &&
            measurement.setting.method == exact_setting(measurement.setting.quality).method)
            return &measurement;
    return nullptr;
}

}  // namespace

std::string Sweep::scene_name() const { return title_of(options); }

std::vector<Setting> settings_of(const Frame& frame, std::uint64_t most_layers,
                                 std::span<const std::string_view> methods) {
    std::vector<Setting> settings = settings_for(frame, most_layers);
    std::erase_if(settings,
                  [&](const Setting& setting) { return !is_named(setting.method->name, methods); });
    return settings;
}

std::vector<Setting> settings_of_samples(const Frame& frame) {
    std::vector<Setting> settings;
    for (const int samples : {1, 2, 4, 8}) {
        settings.push_back(exact_setting(frame.quality));
        settings.back().quality.coverage = Coverage::samples;
        settings.back().quality.samples = samples;
    }
    settings.push_back(exact_setting(frame.quality));
    return settings;
}

std::vector<LeftOut> left_out(const Frame& frame, std::span<const std::string_view> names) {
    std::vector<LeftOut> result;
    for (const MethodInfo& method : methods()) {
        if (!is_named(method.name, names)) continue;
        const std::string reason = method.refusal(frame, features_of(frame));
        if (!reason.empty()) result.push_back({method.name, reason});
    }
    return result;
}

std::vector<Measurement> measure_interleaved(const cellist::Device& device, const Frame& frame,
                                             const Reference& reference,
                                             std::span<const Setting> settings,
                                             std::uint32_t frames,
                                             const std::function<void(Measurement&)>& measured,
                                             const std::function<void(double)>& progress) {
    std::vector<Measurement> measurements;
    for (const Setting& setting : settings) {
        measurements.push_back(measure(device, frame, setting, reference, frames_in(0, frames)));
        measured(measurements.back());
    }
    for (std::uint32_t round = 1; round < rounds && frames_in(round, frames) > 0; ++round)
        for (std::size_t i = 0; i < measurements.size(); ++i) {
            progress((round - 1 + static_cast<double>(i) / static_cast<double>(settings.size())) /
                     (rounds - 1));
            measure_again(device, frame, frames_in(round, frames), measurements[i]);
        }
    return measurements;
}

double typical_spread(std::span<const Measurement> measurements) {
    std::vector<double> spreads;
    for (const Measurement& measurement : measurements)
        if (measurement.drawn()) spreads.push_back(measurement.spread());
    return spreads.empty() ? 0 : support::median(std::move(spreads));
}

std::vector<std::uint64_t> pixels_by_layers(const cellist::Lengths& layers) {
    std::vector<std::uint64_t> bins(static_cast<std::size_t>(std::bit_width(layers.longest)) + 1);
    for (const auto& [length, pixels] : layers.histogram)
        bins[static_cast<std::size_t>(std::bit_width(length))] += pixels;
    return bins;
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
            result.push_back(relation(measurement, measurement, *all));
    std::ranges::sort(result, {}, [](const Relation& relation) {
        return *relation.measurement->setting.quality.layers;
    });
    return result;
}

std::vector<Relation> exact_methods(const Sweep& sweep) {
    std::vector<Relation> result;
    const Measurement* all = all_layers(sweep);
    if (all == nullptr || sweep.options.all_samples) return result;
    for (const Measurement& measurement : sweep.measurements)
        if (gives_nothing_up(sweep, measurement))
            result.push_back(relation(measurement, *all, measurement));
    return result;
}

}  // namespace oit
