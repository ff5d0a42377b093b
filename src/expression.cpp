#include "expression.hpp"

#include <algorithm>
#include <array>
#include <string>

#include <cellist/error.hpp>

namespace cellist::detail {

namespace {

using namespace std::string_view_literals;

constexpr std::string_view name_characters =
    "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZ_abcdefghijklmnopqrstuvwxyz";
constexpr std::string_view operators = " \t\r\n+-*/%&|^~!<>=?:.,";

// Comments; what begins trigraphs, where ??/ is a backslash; digraphs for braces, # and brackets.
constexpr std::array refused_pairs{"//"sv, "/*"sv, "??"sv, "<%"sv, "%>"sv, "%:"sv, "<:"sv, ":>"sv};

// The function around the expression, and what not all work-items may reach.
constexpr std::array refused_names{"cellist_sort_key"sv, "barrier"sv};

[[noreturn]] void refuse(std::string_view text, std::size_t at, const std::string& what) {
    throw Error("an expression has " + what + " at character " + std::to_string(at + 1) +
                ", but must be one OpenCL C expression, of names, numbers, operators and calls: " +
                std::string(text));
}

std::string quoted(std::string_view part) { return "'" + std::string(part) + "'"; }

}  // namespace

void check_expression(std::string_view text) {
    if (text.size() > expression_length_max)
        throw Error("an expression of " + std::to_string(text.size()) +
                    " characters exceeds the limit of " + std::to_string(expression_length_max) +
                    ": compute it in the kernel that inserts, and keep it in a member");

    std::string open;  // the closing brackets that are due, innermost last
    for (std::size_t at = 0; at < text.size(); ++at) {
        const char c = text[at];
        if (name_characters.find(c) != std::string_view::npos) {
            const std::size_t end =
                std::min(text.find_first_not_of(name_characters, at), text.size());
            const std::string_view name = text.substr(at, end - at);
            if (std::find(refused_names.begin(), refused_names.end(), name) != refused_names.end())
                refuse(text, at, quoted(name));
            at = end - 1;
        } else if (c == '(' || c == '[') {
            open += c == '(' ? ')' : ']';
        } else if (c == ')' || c == ']') {
            if (open.empty() || open.back() != c)
                refuse(text, at, "an unmatched " + quoted({&c, 1}));
            open.pop_back();
        } else if (operators.find(c) == std::string_view::npos) {
            const auto byte = static_cast<unsigned char>(c);
            refuse(
                text, at,
                byte > ' ' && byte < 127 ? quoted({&c, 1}) : "a byte of " + std::to_string(byte));
        }
        const std::string_view pair = text.substr(at, 2);
        if (std::find(refused_pairs.begin(), refused_pairs.end(), pair) != refused_pairs.end())
            refuse(text, at, quoted(pair));
    }
    if (!open.empty()) refuse(text, text.size(), "no " + quoted(open.substr(open.size() - 1)));
}

}  // namespace cellist::detail
