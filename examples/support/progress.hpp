#pragma once

#include <chrono>
#include <cstdio>
#include <optional>
#include <string>

namespace support {

/// Shows on stderr how far long work is: in one line that changes on a terminal, and elsewhere in a
/// line now and then, first after ten seconds and then ever more seldom.
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
    std::chrono::milliseconds next_;               ///< when a line is due, from the start
};

}  // namespace support
