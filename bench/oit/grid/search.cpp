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

FrameTimes figures_of(const std::vector<double>& times_ms) {
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
        ChannelErrors told = off;
        if (const auto others = as_right_.find(p); others != as_right_.end())
            for (const Colour& other : others->second)
                if (const ChannelErrors its = difference(is, other); largest(its) < largest(told))
                    told = its;
        add(errors.told, told, channels);
    }
    return errors;
}

std::uint64_t Truth::pixels_ambiguous() const {
    return static_cast<std::uint64_t>(std::ranges::count(reference_.ambiguous, true));
}

struct Search::Drawn {
    Frame frame;
    Renderer renderer;

    Drawn(const cellist::Device& device, const Frame& of, const Setting& setting)
        : frame(with_setting(of, setting)), renderer(device, frame, *setting.method) {}
};

Search::Search(const cellist::Device& device, const Frame& frame, std::uint32_t runs)
    : frame_(frame), truth_(device, frame), runs_(runs) {
    // Rounding alone may give the device one layer more than the reference.
    for (const Setting& setting : settings_for(frame, truth_.reference().most_layers() + 1))
        trials_.push_back({.setting = setting});
    drawn_.resize(trials_.size());
    support::Progress progress("settings");
    for (std::size_t i = 0; i < trials_.size(); ++i) {
        progress.update(static_cast<double>(i) / static_cast<double>(trials_.size()));
        draw(device, frame, trials_[i]);
    }
    time_all();
}

Search::~Search() = default;

void Search::draw(const cellist::Device& device, const Frame& frame, Trial& trial) {
    try {
        auto own = std::make_unique<Drawn>(device, frame, trial.setting);
        own->renderer.warm_up();
        trial.times = figures_of({own->renderer.draw()});
        trial.errors = truth_.errors_of(own->renderer.image());
        drawn_[static_cast<std::size_t>(&trial - trials_.data())] = std::move(own);
    } catch (const std::exception& error) {
        const std::string message = error.what();
        trial.failure = message.substr(0, message.find('\n'));
    }
}

void Search::time_all() {
    const Trial* exact = find(exact_setting(frame_.quality));
    if (!exact || !exact->failure.empty())
        throw std::runtime_error("all layers in float cannot be drawn: " +
                                 (exact ? exact->failure : std::string("no such setting")));
    std::vector<const Trial*> near;
    for (const Trial& trial : trials_)
        if (trial.failure.empty() && trial.times.median_ms < far_slower * exact->times.median_ms)
            near.push_back(&trial);
    const std::vector<FrameTimes> times = draw_by_turns(near, runs_);
    for (std::size_t i = 0; i < near.size(); ++i)
        trials_[static_cast<std::size_t>(near[i] - trials_.data())].times = times[i];
}

const Trial* Search::best(const Budget& budget) {
    std::vector<const Trial*> within;
    for (const Trial& trial : trials_)
        if (trial.failure.empty() && budget.met_by(trial.errors.told)) within.push_back(&trial);
    if (within.empty()) return nullptr;
    const auto cost = [](const Trial* trial) { return trial->times.median_ms; };
    const double cheapest = cost(std::ranges::min(within, {}, cost));
    std::erase_if(within, [&](const Trial* trial) { return cost(trial) > nearly * cheapest; });
    const std::vector<FrameTimes> times = time_again(within);
    const auto least = std::ranges::min_element(times, {}, &FrameTimes::median_ms);
    return within[static_cast<std::size_t>(least - times.begin())];
}

const Trial* Search::find(const Setting& setting) const {
    const auto at = std::ranges::find(trials_, text(setting),
                                      [](const Trial& trial) { return text(trial.setting); });
    return at == trials_.end() ? nullptr : &*at;
}

std::vector<FrameTimes> Search::time_again(std::span<const Trial* const> trials) {
    return draw_by_turns(trials, 2 * runs_ + 1);
}

std::vector<FrameTimes> Search::draw_by_turns(std::span<const Trial* const> trials,
                                              std::uint32_t runs) {
    std::vector<std::vector<double>> times(trials.size());
    const support::Stopwatch stopwatch;
    const double enough = enough_ms * static_cast<double>(trials.size());
    for (std::size_t turn = 0; turn < runs || (turn < most_runs && stopwatch.ms() < enough); ++turn)
        for (std::size_t i = 0; i < trials.size(); ++i)
            times[i].push_back(drawn(*trials[i]).renderer.draw());
    std::vector<FrameTimes> figures;
    for (const std::vector<double>& own : times) figures.push_back(figures_of(own));
    return figures;
}

}  // namespace oit
