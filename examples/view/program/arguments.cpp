// SPDX-License-Identifier: MIT
#include "program/arguments.hpp"

#include <algorithm>
#include <cctype>

namespace viewer {
namespace {

auto place_of(auto& options, std::string_view name) {
    return std::ranges::lower_bound(options, name, {}, &Arguments::Option::first);
}

std::string quoted(const std::string& word) {
    const auto is_plain = [](unsigned char c) {
        return std::isalnum(c) != 0 ||
               std::string_view("-_./:,=+@%").find(static_cast<char>(c)) != std::string_view::npos;
    };
    if (!word.empty() && std::ranges::all_of(word, is_plain)) return word;
    std::string text = "'";
    for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return text + "'";
}

}  // namespace

std::string Arguments::get(std::string_view name, std::string_view missing) const {
    const auto place = place_of(options_, name);
    return place != options_.end() && place->first == name ? place->second : std::string(missing);
}

bool Arguments::has(std::string_view name) const {
    const auto place = place_of(options_, name);
    return place != options_.end() && place->first == name;
}

void Arguments::set(const std::string& name, const std::string& text) {
    const auto place = place_of(options_, name);
    if (place != options_.end() && place->first == name)
        place->second = text;
    else
        options_.insert(place, {name, text});
}

void Arguments::remove(std::string_view name) {
    std::erase_if(options_, [&](const Option& option) { return option.first == name; });
}

Arguments Arguments::without(std::initializer_list<std::string_view> names) const {
    Arguments rest = *this;
    for (const std::string_view name : names) rest.remove(name);
    return rest;
}

std::vector<std::string> Arguments::words(std::string_view program) const {
    std::vector<std::string> words{std::string(program)};
    words.insert(words.end(), scene.begin(), scene.end());
    for (const auto& [name, text] : options_) {
        words.push_back(name);
        if (!text.empty()) words.push_back(text);
    }
    return words;
}

std::string Arguments::command_line(std::string_view program) const {
    std::string line;
    for (const std::string& word : words(program)) line += (line.empty() ? "" : " ") + quoted(word);
    return line;
}

}  // namespace viewer
