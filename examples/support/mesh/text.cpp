// SPDX-License-Identifier: MIT
#include "text.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <system_error>

namespace support {
namespace {

// std::from_chars takes '-', but no '+'.
std::string_view without_plus(std::string_view word) {
    if (word.size() > 1 && word[0] == '+' && word[1] != '-' && word[1] != '+')
        word.remove_prefix(1);
    return word;
}

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }
bool is_line_end(char c) { return c == '\n' || c == '\r'; }

}  // namespace

std::optional<double> parse_number(std::string_view word) {
    word = without_plus(word);
    double value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (end != word.data() + word.size() || error == std::errc::invalid_argument)
        return std::nullopt;
    if (error == std::errc::result_out_of_range) {
        const bool negative = word[0] == '-';
        if (negative) word.remove_prefix(1);
        const std::size_t exponent = word.find_first_of("eE");
        const bool tiny = exponent != std::string_view::npos ? word[exponent + 1] == '-'
                                                             : word[0] == '0' || word[0] == '.';
        value = tiny ? 0 : std::numeric_limits<double>::infinity();
        if (negative) value = -value;
    }
    return value;
}

std::optional<std::int64_t> parse_integer(std::string_view word) {
    word = without_plus(word);
    std::int64_t value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (end != word.data() + word.size() || error != std::errc()) return std::nullopt;
    return value;
}

float to_float(double value) {
    if (std::abs(value) > static_cast<double>(std::numeric_limits<float>::max()))
        return value > 0 ? std::numeric_limits<float>::infinity()
                         : -std::numeric_limits<float>::infinity();
    return static_cast<float>(value);
}

float linear_from_srgb(double value) {
    return static_cast<float>(value <= 0.04045 ? value / 12.92
                                               : std::pow((value + 0.055) / 1.055, 2.4));
}

std::string printable(std::string_view word) {
    constexpr std::size_t most = 40;
    std::string text(word.substr(0, most));
    std::replace_if(
        text.begin(), text.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
    return word.size() > most ? text + "..." : text;
}

void TextCursor::skip_line_end() {
    if (text_[at_] == '\r' && at_ + 1 < text_.size() && text_[at_ + 1] == '\n') ++at_;
    ++at_;
    ++line_;
}

std::string_view TextCursor::next_word_on_line() {
    while (at_ < text_.size() && is_blank(text_[at_])) ++at_;
    const std::size_t begin = at_;
    if (at_ < text_.size() && comment_ != '\0' && text_[at_] == comment_) {
        while (at_ < text_.size() && !is_line_end(text_[at_])) ++at_;
        return {};
    }
    while (at_ < text_.size() && !is_blank(text_[at_]) && !is_line_end(text_[at_]) &&
           (comment_ == '\0' || text_[at_] != comment_))
        ++at_;
    return text_.substr(begin, at_ - begin);
}

bool TextCursor::at_line_end() const {
    TextCursor ahead = *this;
    return ahead.next_word_on_line().empty();
}

std::string_view TextCursor::next_word() {
    for (;;) {
        const std::string_view word = next_word_on_line();
        if (!word.empty() || at_end()) return word;
        skip_line_end();
    }
}

bool TextCursor::has_lines(std::uint64_t count) const {
    TextCursor ahead = *this;
    for (; count > 0 && !ahead.at_end(); (void)ahead.rest_of_line())
        if (!ahead.next_word_on_line().empty()) --count;
    return count == 0;
}

std::string_view TextCursor::rest_of_line() {
    const std::size_t begin = at_;
    while (at_ < text_.size() && !is_line_end(text_[at_])) ++at_;
    const std::string_view rest = text_.substr(begin, at_ - begin);
    if (at_ < text_.size()) skip_line_end();
    return rest;
}

}  // namespace support
