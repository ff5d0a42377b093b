#include "progress.hpp"

#include <cstdio>
#include <utility>

#include <unistd.h>

namespace support {

Progress::Progress(std::string label)
    : label_(std::move(label)), on_terminal_(isatty(fileno(stderr)) == 1) {}

Progress::~Progress() {
    if (on_terminal_ && percent_ >= 0) std::fputs("\r\x1b[K", stderr);
}

void Progress::update(double fraction) {
    const int percent = static_cast<int>(100 * fraction);
    if (!on_terminal_ || percent == percent_) return;
    percent_ = percent;
    std::fprintf(stderr, "\r%s %3d %%", label_.c_str(), percent);
    std::fflush(stderr);
}

}  // namespace support
