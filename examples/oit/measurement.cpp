#include "measurement.hpp"

#include <algorithm>
#include <exception>

#include "renderer.hpp"
#include "stopwatch.hpp"

namespace oit {
namespace {

constexpr double most_ms = 10'000;  // so that a slow method does not hold up all others

void time_frames(Renderer& renderer, std::uint32_t runs, Measurement& result) {
    const support::Stopwatch stopwatch;
    renderer.warm_up();
    std::vector<double> times;
    do times.push_back(renderer.draw());
    while (times.size() < runs && stopwatch.ms() < most_ms);
    result.runs = static_cast<std::uint32_t>(times.size());
    result.fastest = std::ranges::min(times);
    result.milliseconds = support::median(std::move(times));
}

}  // namespace

Measurement measure(const cellist::Device& device, const Frame& frame, const Setting& setting,
                    const Reference& reference, std::uint32_t runs) {
    Measurement result{.setting = setting};
    const Frame drawn = with_setting(frame, setting);
    try {
        Renderer renderer(device, drawn, *setting.method);
        time_frames(renderer, runs, result);
        result.bytes = renderer.method().device_bytes();
        result.image = renderer.image();
    } catch (const std::exception& error) {
        const std::string message = error.what();
        result.failure = message.substr(0, message.find('\n'));
        return result;
    }
    result.comparison = compare(reference, result.image, {});
    return result;
}

}  // namespace oit
