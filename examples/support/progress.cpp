// SPDX-License-Identifier: MIT
#include "progress.hpp"

#include <utility>

#include <unistd.h>

namespace support {

Progress::Progress(std::string label, std::FILE* out, std::chrono::milliseconds first)
    : label_(std::move(label)), out_(out), on_terminal_(isatty(fileno(out)) == 1), next_(first) {}

Progress::~Progress() {
    if (on_terminal_ && percent_ >= 0) std::fputs("\r\x1b[K", out_);
}

void Progress::update(double fraction) {
    const int percent = static_cast<int>(100 * fraction);
    if (percent == percent_) return;
    if (on_terminal_) {
        std::fprintf(out_, "\r%s %3d %%", label_.c_str(), percent);
    } else {
        const Clock::time_point now = Clock::now();
        if (!start_) start_ = now;
        const auto passed = now - *start_;
        if (passed < next_) return;
        while (next_ <= passed) next_ += next_ / 2 + std::chrono::milliseconds(1);
        std::fprintf(out_, "%s %d %%\n", label_.c_str(), percent);
    }
    percent_ = percent;
    std::fflush(out_);
}

}  // namespace support
