// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstdio>
#include <optional>
#include <string>

namespace support {

/// Shows the progress of long work on stderr. On a terminal, one line changes. Elsewhere, a new
/// line appears after ten seconds, and further lines after ever longer times.
class Progress {
public:
    /// `out` and `first` are for tests.
    explicit Progress(std::string label, std::FILE* out = stderr,
                      std::chrono::milliseconds first = std::chrono::seconds(10));
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;
    /// Clears the line on a terminal.
    ~Progress();

    /// `fraction` runs from 0 to 1. Prints when the whole percentage changed.
    void update(double fraction);

private:
    using Clock = std::chrono::steady_clock;

    std::string label_;
    std::FILE* out_;
    bool on_terminal_;
    int percent_ = -1;
    std::optional<Clock::time_point> start_ = {};  ///< of the work: the first update
    std::chrono::milliseconds next_;               ///< time of the next line, from the start
};

}  // namespace support
