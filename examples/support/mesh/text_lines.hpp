// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "text.hpp"

namespace support {

/// Walks through the lines of an OBJ or MTL file. LF, CR and CRLF end a line. A backslash at its
/// end continues the line on the next one, except in a comment, where it may end a Windows path.
/// Skips a byte order mark.
class TextLines {
public:
    explicit TextLines(std::string_view text);

    /// Moves to the next line; false at the end of the text.
    bool next();

    /// The line, without its end. Valid until next().
    [[nodiscard]] std::string_view line() const { return line_; }
    /// The number of the line's first part. The first line is 1.
    [[nodiscard]] std::uint64_t number() const { return number_; }
    /// Whether the text ends within this line, so that it may be truncated.
    [[nodiscard]] bool is_open() const { return is_open_; }
    /// Whether the text ends after a backslash that continues the line.
    [[nodiscard]] bool is_unfinished() const { return is_unfinished_; }

private:
    std::string_view physical_line();

    std::string_view text_;
    TextCursor physical_lines_;
    std::uint64_t number_ = 0;
    std::string_view line_;
    std::string joined_;
    bool is_open_ = false, is_unfinished_ = false;
};

/// Replaces `words` by the words of a line: blanks and tabs separate them.
void split(std::string_view line, std::vector<std::string_view>& words);

/// The line up to the first '#'.
[[nodiscard]] std::string_view without_comment(std::string_view line);

/// The text after the first word of a line. It may contain blanks and '#'.
[[nodiscard]] std::string_view name_of(std::string_view line);

}  // namespace support
