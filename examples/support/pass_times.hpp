#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <cellist/device.hpp>

#include "stopwatch.hpp"

namespace support {

/// Milliseconds of each pass, in the order of their first run. Waits after every pass, so that
/// passes do not overlap: their sum exceeds the time of a frame.
class PassTimes {
public:
    explicit PassTimes(const cellist::Device& device) : device_(device) { device_.finish(); }

    /// The pass that ends here. Blocks.
    void end(const std::string& pass) {
        device_.finish();
        const double ms = watch_.ms();
        const auto known = std::ranges::find(times_, pass, &std::pair<std::string, double>::first);
        if (known == times_.end())
            times_.emplace_back(pass, ms);
        else
            known->second += ms;
        watch_ = Stopwatch();
    }
    [[nodiscard]] const std::vector<std::pair<std::string, double>>& all() const { return times_; }

private:
    const cellist::Device& device_;
    Stopwatch watch_;
    std::vector<std::pair<std::string, double>> times_;
};

}  // namespace support
