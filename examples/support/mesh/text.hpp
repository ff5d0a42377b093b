// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace support {

/// Reads a number of a text file, in any locale: "1", "+1.5e-3", "nan", "-inf". The whole word must
/// be the number, and must not be hexadecimal. A magnitude beyond double becomes infinity or zero.
[[nodiscard]] std::optional<double> parse_number(std::string_view word);

/// Reads an integer with an optional sign, of up to 64 bits.
[[nodiscard]] std::optional<std::int64_t> parse_integer(std::string_view word);

/// A magnitude beyond float becomes infinity.
[[nodiscard]] float to_float(double value);

/// A linear colour channel from an sRGB one (IEC 61966-2-1), both 0 to 1.
[[nodiscard]] float linear_from_srgb(double value);

/// A word of a file for a message: at most 40 characters, control characters replaced by '?'.
[[nodiscard]] std::string printable(std::string_view word);

/// Walks through the words and lines of a text. LF, CR and CRLF end a line. Blanks and tabs
/// separate words.
class TextCursor {
public:
    explicit TextCursor(std::string_view text) : text_(text) {}

    /// The next word on any line; empty at the end of the text.
    [[nodiscard]] std::string_view next_word();
    /// The next word on this line; empty at its end.
    [[nodiscard]] std::string_view next_word_on_line();
    /// Whether no word follows on this line.
    [[nodiscard]] bool at_line_end() const;
    /// Whether at least `count` lines with words follow, including the rest of this line.
    [[nodiscard]] bool has_lines(std::uint64_t count) const;
    /// Returns the rest of this line, without its end, and moves to the next line.
    std::string_view rest_of_line();

    [[nodiscard]] bool at_end() const { return at_ >= text_.size(); }
    [[nodiscard]] std::size_t offset() const { return at_; }
    /// The number of the line on which the last word stood. The first line is 1.
    [[nodiscard]] std::uint64_t line() const { return line_; }
    /// From this character to the end of its line is a comment, which is skipped.
    void set_comment(char mark) { comment_ = mark; }

private:
    void skip_line_end();

    std::string_view text_;
    std::size_t at_ = 0;
    std::uint64_t line_ = 1;
    char comment_ = '\0';
};

}  // namespace support
