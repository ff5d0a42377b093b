#pragma once

#include <string>

namespace support {

/// One line on stderr that shows how far long work is. Prints nothing where stderr is no terminal.
class Progress {
public:
    explicit Progress(std::string label);
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;
    /// Clears the line.
    ~Progress();

    /// `fraction` runs from 0 to 1. Prints when the whole percentage changed.
    void update(double fraction);

private:
    std::string label_;
    bool on_terminal_;
    int percent_ = -1;
};

}  // namespace support
