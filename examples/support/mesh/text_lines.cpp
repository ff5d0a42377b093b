// SPDX-License-Identifier: MIT
#include "text_lines.hpp"

#include <algorithm>

namespace support {
namespace {

constexpr std::string_view blanks = " \t\v\f";

std::string_view trimmed(std::string_view text) {
    const std::size_t begin = text.find_first_not_of(blanks);
    if (begin == std::string_view::npos) return {};
    return text.substr(begin, text.find_last_not_of(blanks) + 1 - begin);
}

bool is_comment(std::string_view line) { return !line.empty() && trimmed(line).starts_with('#'); }

}  // namespace

TextLines::TextLines(std::string_view text)
    : text_(text.starts_with("\xEF\xBB\xBF") ? text.substr(3) : text), physical_lines_(text_) {}

std::string_view TextLines::physical_line() {
    const std::string_view line = physical_lines_.rest_of_line();
    is_open_ = line.data() + line.size() == text_.data() + text_.size();
    return line;
}

bool TextLines::next() {
    if (physical_lines_.at_end()) return false;
    number_ = physical_lines_.line();
    line_ = physical_line();
    if (!trimmed(line_).ends_with('\\') || is_comment(line_)) return true;
    joined_.clear();
    for (std::string_view part = line_;; part = physical_line()) {
        part = trimmed(part);
        const bool continues = part.ends_with('\\');
        if (continues) part.remove_suffix(1);
        joined_.append(part).append(" ");
        if (!continues) break;
        is_unfinished_ = physical_lines_.at_end();
        if (is_unfinished_) break;
    }
    line_ = joined_;
    return true;
}

void split(std::string_view line, std::vector<std::string_view>& words) {
    words.clear();
    for (std::size_t at = line.find_first_not_of(blanks); at < line.size();
         at = line.find_first_not_of(blanks, at)) {
        const std::size_t end = std::min(line.find_first_of(blanks, at), line.size());
        words.push_back(line.substr(at, end - at));
        at = end;
    }
}

std::string_view without_comment(std::string_view line) { return line.substr(0, line.find('#')); }

std::string_view name_of(std::string_view line) {
    line = trimmed(line);
    const std::size_t end = line.find_first_of(blanks);
    return end == std::string_view::npos ? std::string_view() : trimmed(line.substr(end));
}

}  // namespace support
