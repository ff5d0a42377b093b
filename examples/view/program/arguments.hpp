// SPDX-License-Identifier: MIT
#pragma once

#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace viewer {

/// The command line of a program that draws: what it draws, and its options in alphabetic order.
class Arguments {
public:
    /// An option and its text. The text of a flag is empty.
    using Option = std::pair<std::string, std::string>;

    std::vector<std::string> scene = {};  ///< one name, or mesh files

    /// The text of an option, or `missing`.
    [[nodiscard]] std::string get(std::string_view name, std::string_view missing = {}) const;
    [[nodiscard]] bool has(std::string_view name) const;
    void set(const std::string& name, const std::string& text);
    void remove(std::string_view name);

    [[nodiscard]] const std::vector<Option>& options() const { return options_; }
    /// A copy without these options.
    [[nodiscard]] Arguments without(std::initializer_list<std::string_view> names) const;

    /// As main() gets them, after the name of the program.
    [[nodiscard]] std::vector<std::string> words(std::string_view program) const;
    /// A line for a POSIX shell.
    [[nodiscard]] std::string command_line(std::string_view program) const;

    [[nodiscard]] bool operator==(const Arguments&) const = default;

private:
    std::vector<Option> options_;  // each name once
};

/// Calls parse(count, arguments) as main() would, and returns what it returns.
auto parse_with(const Arguments& arguments, std::string_view program, const auto& parse) {
    const std::vector<std::string> words = arguments.words(program);
    std::vector<const char*> pointers;
    for (const std::string& word : words) pointers.push_back(word.c_str());
    return parse(static_cast<int>(pointers.size()), pointers.data());
}

}  // namespace viewer
