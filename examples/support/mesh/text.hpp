#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace support {

/// A number of a text file, in any locale: "1", "+1.5e-3", "nan", "-inf". The whole word must be
/// the number; hexadecimal numbers are none. A magnitude beyond double becomes infinity or zero.
[[nodiscard]] std::optional<double> parse_number(std::string_view word);

/// An integer with an optional sign. Magnitudes beyond 64 bits are no integers.
[[nodiscard]] std::optional<std::int64_t> parse_integer(std::string_view word);

/// A word of a file for a message: control characters become '?', and 40 characters at most are
/// kept.
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
    /// What is left of this line, without its end, and moves to the next line.
    std::string_view rest_of_line();

    [[nodiscard]] bool at_end() const { return at_ >= text_.size(); }
    [[nodiscard]] std::size_t offset() const { return at_; }
    /// The number of the line on which the last word stood. The first line is 1.
    [[nodiscard]] std::uint64_t line() const { return line_; }
    /// Words that start with this character run to the end of their line and are skipped.
    void set_comment(char mark) { comment_ = mark; }

private:
    void skip_line_end();

    std::string_view text_;
    std::size_t at_ = 0;
    std::uint64_t line_ = 1;
    char comment_ = '\0';
};

}  // namespace support
