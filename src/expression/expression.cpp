// SPDX-License-Identifier: MIT
#include "expression/expression.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include <cellist/error.hpp>

namespace cellist::detail {

namespace {

using namespace std::string_view_literals;

constexpr std::string_view name_characters =
    "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZ_abcdefghijklmnopqrstuvwxyz";
constexpr std::string_view digits = "0123456789";
constexpr std::string_view blanks = " \t\r\n";
constexpr std::string_view operators = "+-*/%&|^~!<>=?:.,";

// Comments; the start of trigraphs, of which ??/ is a backslash; digraphs for braces, # and
// brackets; member access through pointers; operators that write.
constexpr std::array refused_operators{"//"sv, "/*"sv, "??"sv, "<%"sv, "%>"sv, "%:"sv,  "<:"sv,
                                       ":>"sv, "->"sv, "++"sv, "--"sv, "+="sv, "-="sv,  "*="sv,
                                       "/="sv, "%="sv, "&="sv, "|="sv, "^="sv, "<<="sv, ">>="sv};

// The functions around expressions, calls that all work-items must reach, and calls that write or
// wait.
constexpr std::array refused_names{"cellist_sort_key"sv,
                                   "cellist_distance"sv,
                                   "cellist_query_position"sv,
                                   "asm"sv,
                                   "barrier"sv,
                                   "fract"sv,
                                   "frexp"sv,
                                   "lgamma_r"sv,
                                   "modf"sv,
                                   "prefetch"sv,
                                   "printf"sv,
                                   "remquo"sv,
                                   "sincos"sv};
// "__" begins what belongs to the compiler: its functions, and inline assembly.
constexpr std::array refused_prefixes{
    "__"sv,          "async_"sv,         "atom_"sv,  "atomic_"sv,    "cellist_insert"sv,
    "mem_fence"sv,   "read_mem_fence"sv, "vstore"sv, "wait_group"sv, "work_group"sv,
    "write_image"sv, "write_mem_fence"sv};

constexpr std::array scalar_types{"bool"sv,     "char"sv,   "const"sv, "double"sv, "float"sv,
                                  "half"sv,     "int"sv,    "long"sv,  "short"sv,  "signed"sv,
                                  "size_t"sv,   "uchar"sv,  "uint"sv,  "ulong"sv,  "unsigned"sv,
                                  "volatile"sv, "ushort"sv, "void"sv};
constexpr std::array vector_lengths{""sv, "2"sv, "3"sv, "4"sv, "8"sv, "16"sv};

bool contains(const auto& list, std::string_view text) {
    return std::find(list.begin(), list.end(), text) != list.end();
}

bool is_refused(std::string_view name) {
    return contains(refused_names, name) ||
           std::any_of(refused_prefixes.begin(), refused_prefixes.end(),
                       [&](std::string_view prefix) { return name.starts_with(prefix); });
}

bool is_type(std::string_view name) {
    const std::size_t end = std::min(name.find_first_of(digits), name.size());
    return contains(scalar_types, name.substr(0, end)) &&
           contains(vector_lengths, name.substr(end));
}

/// Keywords of OpenCL C that are not types.
constexpr std::array keywords{
    "auto"sv,      "break"sv,      "case"sv,     "constant"sv, "continue"sv, "default"sv,
    "do"sv,        "else"sv,       "enum"sv,     "extern"sv,   "for"sv,      "global"sv,
    "goto"sv,      "if"sv,         "inline"sv,   "kernel"sv,   "local"sv,    "private"sv,
    "read_only"sv, "read_write"sv, "register"sv, "restrict"sv, "return"sv,   "sizeof"sv,
    "static"sv,    "struct"sv,     "switch"sv,   "typedef"sv,  "union"sv,    "while"sv,
    "write_only"sv};

/// An open bracket.
struct Bracket {
    char closing;
    bool is_call;      ///< a call or an index: an operand comes before the bracket
    bool holds_types;  ///< only type names so far: closed, they make a cast
};

[[noreturn]] void refuse(std::string_view text, std::size_t at, const std::string& what) {
    throw Error("an expression has " + what + " at character " + std::to_string(at + 1) +
                ", but must be one OpenCL C expression of names, numbers, operators and calls, "
                "without writes and pointers: " +
                std::string(text));
}

std::string quoted(std::string_view part) {
    return std::string(1, '\'').append(part).append(1, '\'');
}

}  // namespace

void check_expression(std::string_view text, const std::string& what) {
    if (text.find_first_not_of(blanks) == std::string_view::npos)
        throw Error("the " + what + " is empty");
    if (text.size() > expression_length_max)
        throw Error("an expression of " + std::to_string(text.size()) +
                    " characters exceeds the limit of " + std::to_string(expression_length_max) +
                    ": compute it in the kernel that inserts, and keep it in a member");

    enum class Token { other, operand, type, member_access, pointer };
    Token before = Token::other;
    std::vector<Bracket> open;  // innermost last
    for (std::size_t at = 0; at < text.size(); ++at) {
        const char c = text[at];
        const std::string_view rest = text.substr(at);
        if (blanks.find(c) != std::string_view::npos) continue;
        if (name_characters.find(c) != std::string_view::npos) {
            const std::string_view name =
                rest.substr(0, std::min(rest.find_first_not_of(name_characters), rest.size()));
            const bool is_member = before == Token::member_access;
            if (!is_member && is_refused(name)) refuse(text, at, quoted(name));
            const bool names_type = !is_member && is_type(name);
            if (names_type && before == Token::pointer) refuse(text, at, quoted(name));
            if (!names_type && !open.empty()) open.back().holds_types = false;
            before = names_type ? Token::type : Token::operand;
            at += name.size() - 1;
            // The point of a number, not of a member.
            if (digits.find(c) != std::string_view::npos && text.substr(at + 1).starts_with('.'))
                ++at;
            continue;
        }
        if (c == '(' || c == '[') {
            if (!open.empty()) open.back().holds_types = false;
            open.push_back(
                {c == '(' ? ')' : ']', before == Token::operand || before == Token::type, true});
            before = Token::other;
            continue;
        }
        if (c == ')' || c == ']') {
            if (open.empty() || open.back().closing != c)
                refuse(text, at, "an unmatched " + quoted(rest.substr(0, 1)));
            if (before == Token::pointer) {
                const std::size_t pointer = text.find_last_of("*&", at);
                refuse(text, pointer, "a pointer " + quoted(text.substr(pointer, 1)));
            }
            const bool is_cast = c == ')' && open.back().holds_types && !open.back().is_call;
            open.pop_back();
            before = is_cast ? Token::other : Token::operand;
            continue;
        }
        if (operators.find(c) == std::string_view::npos) {
            const auto byte = static_cast<unsigned char>(c);
            refuse(
                text, at,
                byte > ' ' && byte < 127 ? quoted({&c, 1}) : "a byte of " + std::to_string(byte));
        }
        for (const std::string_view refused : refused_operators)
            if (rest.starts_with(refused)) refuse(text, at, quoted(refused));
        if (!open.empty()) open.back().holds_types = false;
        if (rest.starts_with("&&") || rest.starts_with("==") || rest.starts_with("!=") ||
            rest.starts_with("<=") || rest.starts_with(">=")) {
            ++at;
            before = Token::other;
            continue;
        }
        if (c == '=') refuse(text, at, quoted("="));
        const bool may_be_pointer = c == '*' || c == '&';
        if (may_be_pointer && before != Token::operand)
            refuse(text, at, "a pointer operator " + quoted({&c, 1}));
        before = may_be_pointer ? Token::pointer : c == '.' ? Token::member_access : Token::other;
    }
    if (!open.empty()) refuse(text, text.size(), "no " + quoted({&open.back().closing, 1}));
}

void check_value_name(std::string_view name) {
    const std::string called = "a value of an expression is called " + quoted(name);
    if (name.empty() || digits.find(name[0]) != std::string_view::npos ||
        name.find_first_not_of(name_characters) != std::string_view::npos)
        throw Error(called + ": use letters, digits and underscores, and no digit first");
    if (name == "record" || contains(keywords, name) || is_type(name) || is_refused(name) ||
        name.starts_with("cellist_") || name.starts_with("CELLIST_"))
        throw Error(called + ", which is reserved: rename it");
}

}  // namespace cellist::detail
