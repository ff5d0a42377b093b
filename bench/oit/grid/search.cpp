// SPDX-License-Identifier: MIT
#include "search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <stdexcept>

#include "image.hpp"
#include "methods/renderer.hpp"
#include "oit/other_orders.hpp"
#include "progress.hpp"
#include "stopwatch.hpp"

namespace oit {
namespace {

constexpr double far_slower = 3;
// Settings within this factor of the cheapest draw again to find the best. It exceeds the noise.
constexpr double nearly = 1.25;
// Short frames draw more often, until they have taken this time.
constexpr double enough_ms = 200;
constexpr std::size_t most_runs = 200;
// The most orders of a pixel's layers to try.
constexpr int most_orders = 5000;

Reference reference_of(const Frame& frame) {
    support::Progress progress("reference");
    return draw_reference(frame, {.progress = [&](double part) { progress.update(part); }});
}

// Of each channel, encoded.
using ChannelErrors = std::array<double, 3>;

ChannelErrors difference(const std::array<double, 3>& a, const std::array<double, 3>& b) {
    return {std::abs(a[0] - b[0]), std::abs(a[1] - b[1]), std::abs(a[2] - b[2])};
}

double largest(const ChannelErrors& errors) { return std::ranges::max(errors); }

void add(PictureError& to, const ChannelErrors& errors, double channels) {
    to.largest = std::max(to.largest, largest(errors));
    for (const double error : errors) to.mean_square += error * error / channels;
}

FrameTimes metrics_of(const std::vector<double>& times_ms) {
    return {support::median(times_ms), std::ranges::min(times_ms), times_ms.size()};
}

}  // namespace

Truth::Truth(const cellist::Device& device, const Frame& frame) : reference_(reference_of(frame)) {
    const Setting setting = exact_setting(frame.quality);
    const Frame exact = with_setting(frame, setting);
    Renderer renderer(device, exact, *setting.method);
    renderer.draw();
    const std::vector<cl_float4> drawn = renderer.image();
    for (std::size_t p = 0; p < drawn.size(); ++p) {
        if (!reference_.ambiguous[p]) continue;
        std::vector<Colour>& colours = as_right_[p];
        const auto take = [&](const glm::dvec3& colour) {
            const Colour encoded{support::srgb_from_linear(colour.x),
                                 support::srgb_from_linear(colour.y),
                                 support::srgb_from_linear(colour.z)};
            if (std::ranges::find(colours, encoded) == colours.end()) colours.push_back(encoded);
            return false;
        };
        take({drawn[p].s[0], drawn[p].s[1], drawn[p].s[2]});
        bench::any_other_order(reference_, p, frame.quality.samples, most_orders, take);
    }
}

PictureErrors Truth::errors_of(std::span<const cl_float4> image) const {
    const auto channels = 3 * static_cast<double>(image.size());
    PictureErrors errors;
    for (std::size_t p = 0; p < image.size(); ++p) {
        Colour is, expected;
        for (std::size_t c = 0; c < is.size(); ++c) {
            is[c] = support::srgb_from_linear(static_cast<double>(image[p].s[c]));
            expected[c] = support::srgb_from_linear(reference_.image[p][static_cast<int>(c)]);
        }
        const ChannelErrors off = difference(is, expected);
        add(errors.all, off, channels);
        ChannelErrors resolved = off;
        if (const auto others = as_right_.find(p); others != as_right_.end())
            for (const Colour& other : others->second)
                if (const ChannelErrors its = difference(is, other);
                    largest(its) < largest(resolved))
                    resolved = its;
        add(errors.resolved, resolved, channels);
    }
    return errors;
}

std::uint64_t Truth::pixels_ambiguous() const {
    return static_cast<std::uint64_t>(std::ranges::count(reference_.ambiguous, true));
}

struct ExhaustiveSearch::Drawn {
    Frame frame;
    Renderer renderer;

    Drawn(const cellist::Device& device, const Frame& of, const Setting& setting)
        : frame(with_setting(of, setting)), renderer(device, frame, *setting.method) {}
};

ExhaustiveSearch::ExhaustiveSearch(const cellist::Device& device, const Frame& frame,
                                   std::uint32_t runs)
    : frame_(frame), truth_(device, frame), runs_(runs) {
    // Rounding alone may give the device one layer more than the reference.
    for (const Setting& setting : settings_for(frame, truth_.reference().most_layers() + 1))
        measurements_.push_back({.setting = setting});
    drawn_.resize(measurements_.size());
    support::Progress progress("settings");
    for (std::size_t i = 0; i < measurements_.size(); ++i) {
        progress.update(static_cast<double>(i) / static_cast<double>(measurements_.size()));
        draw(device, frame, measurements_[i]);
    }
    time_all();
}

ExhaustiveSearch::~ExhaustiveSearch() = default;

void ExhaustiveSearch::draw(const cellist::Device& device, const Frame& frame,
                            SettingMeasurement& measurement) {
    try {
        auto own = std::make_unique<Drawn>(device, frame, measurement.setting);
        own->renderer.warm_up();
        measurement.times = metrics_of({own->renderer.draw()});
        measurement.errors = truth_.errors_of(own->renderer.image());
        drawn_[static_cast<std::size_t>(&measurement - measurements_.data())] = std::move(own);
    } catch (const std::exception& error) {
        const std::string message = error.what();
        measurement.failure = message.substr(0, message.find('\n'));
    }
}

void ExhaustiveSearch::time_all() {
    const SettingMeasurement* exact = find(exact_setting(frame_.quality));
    if (!exact || !exact->failure.empty())
        throw std::runtime_error("all layers in float cannot be drawn: " +
                                 (exact ? exact->failure : std::string("no such setting")));
    std::vector<const SettingMeasurement*> near;
    for (const SettingMeasurement& measurement : measurements_)
        if (measurement.failure.empty() &&
            measurement.times.median_ms < far_slower * exact->times.median_ms)
            near.push_back(&measurement);
    const std::vector<FrameTimes> times = draw_interleaved(near, runs_);
    for (std::size_t i = 0; i < near.size(); ++i)
        measurements_[static_cast<std::size_t>(near[i] - measurements_.data())].times = times[i];
}

const SettingMeasurement* ExhaustiveSearch::best(const Budget& budget) {
    std::vector<const SettingMeasurement*> within;
    for (const SettingMeasurement& measurement : measurements_)
        if (measurement.failure.empty() && budget.met_by(measurement.errors.resolved))
            within.push_back(&measurement);
    if (within.empty()) return nullptr;
    const auto cost = [](const SettingMeasurement* measurement) {
        return measurement->times.median_ms;
    };
    const double cheapest = cost(std::ranges::min(within, {}, cost));
    std::erase_if(within, [&](const SettingMeasurement* measurement) {
        return cost(measurement) > nearly * cheapest;
    });
    const std::vector<FrameTimes> times = time_again(within);
    const auto least = std::ranges::min_element(times, {}, &FrameTimes::median_ms);
    return within[static_cast<std::size_t>(least - times.begin())];
}

const SettingMeasurement* ExhaustiveSearch::find(const Setting& setting) const {
    const auto at = std::ranges::find(
        measurements_, text(setting),
        [](const SettingMeasurement& measurement) { return text(measurement.setting); });
    return at == measurements_.end() ? nullptr : &*at;
}

std::vector<FrameTimes> ExhaustiveSearch::time_again(
    std::span<const SettingMeasurement* const> measurements) {
    return draw_interleaved(measurements, 2 * runs_ + 1);
}

std::vector<FrameTimes> ExhaustiveSearch::draw_interleaved(
    std::span<const SettingMeasurement* const> measurements, std::uint32_t runs) {
    std::vector<std::vector<double>> times(measurements.size());
    const support::Stopwatch stopwatch;
    const double enough = enough_ms * static_cast<double>(measurements.size());
    for (std::size_t turn = 0; turn < runs || (turn < most_runs && stopwatch.ms() < enough); ++turn)
        for (std::size_t i = 0; i < measurements.size(); ++i)
            times[i].push_back(drawn(*measurements[i]).renderer.draw());
    std::vector<FrameTimes> metrics;
    for (const std::vector<double>& own : times) metrics.push_back(metrics_of(own));
    return metrics;
}

}  // namespace oit
