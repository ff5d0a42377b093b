// SPDX-License-Identifier: MIT
// Expressions of sort_by. Input: 'g' and bytes that choose an expression of a small grammar, whose
// values are computed here too; or any text, which is sorted by, or refused.
#include <algorithm>
#include <cfloat>
#include <cmath>
#include <concepts>
#include <memory>
#include <optional>
#include <regex>
#include <variant>
#include <vector>

#include <cellist/cellist.hpp>

#include "expression/expression.hpp"
#include "input.hpp"

namespace cellist::fuzz {

struct Values {
    cl_long wide;
    cl_ulong uwide;
    cl_int number;
    cl_uint unumber;
    cl_float real;
    cl_short small;
    cl_uchar byte;
};
CELLIST_STRUCT(Values, wide, uwide, number, unumber, real, small, byte);

namespace {

// ---- lists of records with extreme and with small values, in every storage

constexpr std::size_t storages = 3;
constexpr std::uint64_t cells = 2;

/// Most in one cell: one list is sorted as a short one, the other as a long one.
const std::vector<std::vector<Values>>& records() {
    static const std::vector<std::vector<Values>> all = [] {
        std::vector<std::vector<Values>> made(cells);
        for (cl_uint i = 0; i < 90; ++i) {
            Values v{};
            v.number = static_cast<cl_int>(i % 7) - 3;
            v.unumber = i / 3;
            v.wide = static_cast<cl_long>(i % 5) - 2;
            v.uwide = i % 11;
            v.real = static_cast<cl_float>(static_cast<cl_int>(i % 13) - 6) / 4;
            v.small = static_cast<cl_short>(static_cast<cl_int>(i) - 45);
            v.byte = static_cast<cl_uchar>(i);
            if (i % 17 == 1) v.number = i % 2 == 0 ? INT32_MIN : INT32_MAX;
            if (i % 19 == 2) v.unumber = 0xFFFFFFFF;
            if (i % 23 == 3) v.wide = i % 2 == 0 ? INT64_MIN : INT64_MAX;
            if (i % 29 == 4) v.uwide = ~cl_ulong{0};
            if (i % 11 == 5) v.real = -0.0f;
            made[i % 5 == 0 ? 0 : 1].push_back(v);
        }
        return made;
    }();
    return all;
}

std::unique_ptr<Lists<Values>> make_lists(const Device& device, Storage storage) {
    std::vector<cl_uint> cell_of;
    std::vector<Values> flat;
    for (std::size_t cell = 0; cell < cells; ++cell)
        for (const Values& values : records()[cell]) {
            cell_of.push_back(static_cast<cl_uint>(cell));
            flat.push_back(values);
        }
    auto lists =
        std::make_unique<Lists<Values>>(device, Shape{cells}, ListsOptions{.storage = storage});
    Kernel insert(device,
                  "kernel void insert_all(CELLIST_LISTS(Values, lists), global const uint* cells,\n"
                  "                       global const Values* records)\n{\n"
                  "    const uint i = get_global_id(0);\n"
                  "    cellist_insert(lists, cells[i], records[i]);\n}\n",
                  "insert_all", *lists);
    lists->build(insert, flat.size(), Buffer<cl_uint>(device, cell_of),
                 Buffer<Values>(device, flat));
    return lists;
}

auto members(const Values& v) {
    // Floats are in the grammar's order: -0 before +0.
    return std::tuple(v.wide, v.uwide, v.number, v.unumber, v.real, !std::signbit(v.real), v.small,
                      v.byte);
}

// ---- the grammar

/// A value of an expression, or none where C leaves it undefined, or devices differ.
using Number = std::variant<cl_int, cl_uint, cl_long, cl_ulong, cl_float>;
using Value = std::optional<Number>;

struct Node {
    enum class Kind { member, literal, minus, complement, negation, binary, condition, cast };
    Kind kind;
    std::string text;  ///< of a member or a literal, an operator, or a type
    Number literal{};
    std::vector<Node> operands;
};

/// The type of an expression, as one of its values.
Number type_of(const Node& node, const Values& any);

bool is_float(const Number& number) { return std::holds_alternative<cl_float>(number); }

constexpr const char* types[] = {"int", "uint", "long", "ulong", "float"};
constexpr const char* member_names[] = {"wide", "uwide", "number", "unumber",
                                        "real", "small", "byte"};
constexpr const char* operators[] = {
    "+", "-", "*", "<", "<=", ">", ">=", "==", "!=", "&", "|", "^", "&&", "||"};

Number member(const std::string& name, const Values& v) {
    if (name == "wide") return v.wide;
    if (name == "uwide") return v.uwide;
    if (name == "number") return v.number;
    if (name == "unumber") return v.unumber;
    if (name == "real") return v.real;
    if (name == "small") return cl_int{v.small};
    return cl_int{v.byte};
}

Node take_node(Input& input, unsigned depth) {
    const std::size_t choice = depth == 0 || input.empty() ? input.below(2) : input.below(9);
    if (choice == 0) return {Node::Kind::member, member_names[input.below(7)], {}, {}};
    if (choice == 1) {
        const auto value = input.number<std::uint16_t>();
        const std::string digits = std::to_string(value);
        switch (input.below(5)) {
            case 0:
                return {Node::Kind::literal, digits, cl_int{value}, {}};
            case 1:
                return {Node::Kind::literal, digits + "u", cl_uint{value}, {}};
            case 2:
                return {Node::Kind::literal, digits + "L", cl_long{value}, {}};
            case 3:
                return {Node::Kind::literal, digits + "UL", cl_ulong{value}, {}};
            default:
                return {
                    Node::Kind::literal, digits + ".5f", static_cast<cl_float>(value) + 0.5f, {}};
        }
    }
    Node node{Node::Kind::binary, operators[input.below(std::size(operators))], {}, {}};
    if (choice == 2) node = {Node::Kind::minus, "-", {}, {}};
    if (choice == 3) node = {Node::Kind::complement, "~", {}, {}};
    if (choice == 4) node = {Node::Kind::negation, "!", {}, {}};
    if (choice == 5) node = {Node::Kind::condition, "?", {}, {}};
    if (choice == 6) node = {Node::Kind::cast, types[input.below(5)], {}, {}};
    const std::size_t operands = node.kind == Node::Kind::condition ? 3
                                 : node.kind == Node::Kind::binary  ? 2
                                                                    : 1;
    for (std::size_t i = 0; i < operands; ++i) {
        node.operands.push_back(take_node(input, depth - 1));
        // Operators of integers take integers, and OpenCL C takes no float as a condition.
        const bool integers = node.kind == Node::Kind::complement || node.text == "&" ||
                              node.text == "|" || node.text == "^" || (node.text == "?" && i == 0);
        Node& operand = node.operands.back();
        if (integers && is_float(type_of(operand, {})))
            operand = {Node::Kind::negation, "!", {}, {std::move(operand)}};
    }
    return node;
}

std::string text_of(const Node& node, Input& input) {
    constexpr const char* blanks[] = {"", "", " ", "\t", "\n", "  "};
    const auto blank = [&] { return std::string(blanks[input.below(std::size(blanks))]); };
    std::vector<std::string> operands;
    for (const Node& operand : node.operands)
        operands.push_back(blank() + "(" + text_of(operand, input) + blank() + ")");
    switch (node.kind) {
        case Node::Kind::member:
            return "record" + blank() + "." + blank() + node.text;
        case Node::Kind::literal:
            return node.text;
        case Node::Kind::binary:
            return operands[0] + node.text + operands[1];
        case Node::Kind::condition:
            return operands[0] + "?" + operands[1] + ":" + operands[2];
        case Node::Kind::cast:
            return "(" + node.text + ")" + operands[0];
        default:
            return node.text + operands[0];
    }
}

/// A float that no device rounds or flushes in another way.
Value plain(cl_float value) {
    if (!std::isfinite(value) || (value != 0 && std::abs(value) < FLT_MIN)) return {};
    return value;
}

/// Compilers may fuse a product with a sum, so products must be exact.
Value product(cl_float a, cl_float b) {
    const cl_float value = a * b;
    const auto wide = [](cl_float x) { return static_cast<double>(x); };
    if (wide(a) * wide(b) != wide(value)) return {};
    return plain(value);
}

/// The integers of C with the sum, difference or product of two; none where a signed one overflows.
template <std::integral T>
Value arithmetic(char sign, T a, T b) {
    T value{};
    const bool overflows = sign == '+'   ? __builtin_add_overflow(a, b, &value)
                           : sign == '-' ? __builtin_sub_overflow(a, b, &value)
                                         : __builtin_mul_overflow(a, b, &value);
    if (overflows && std::signed_integral<T>) return {};
    return value;
}

/// One binary operator but && and ||, on two numbers of the same type.
template <class T>
Value binary(const std::string& text, T a, T b) {
    if (text == "<") return cl_int{a < b};
    if (text == "<=") return cl_int{a <= b};
    if (text == ">") return cl_int{a > b};
    if (text == ">=") return cl_int{a >= b};
    if (text == "==") return cl_int{!(a < b) && !(b < a)};
    if (text == "!=") return cl_int{a < b || b < a};
    if constexpr (std::integral<T>) {
        if (text == "&") return static_cast<T>(a & b);
        if (text == "|") return static_cast<T>(a | b);
        if (text == "^") return static_cast<T>(a ^ b);
        return arithmetic(text[0], a, b);
    } else {
        if (text == "+") return plain(a + b);
        if (text == "-") return plain(a - b);
        return product(a, b);
    }
}

bool is_true(const Number& number) {
    return std::visit([](auto value) { return value < 0 || value > 0; }, number);
}

template <class T>
Value converted(const Number& number) {
    return std::visit(
        [](auto value) -> Value {
            if constexpr (std::floating_point<decltype(value)> && std::integral<T>) {
                const double end = std::ldexp(1.0, std::numeric_limits<T>::digits);
                const auto wide = static_cast<double>(value);
                const double least = std::signed_integral<T> ? -end : -1.0;
                if (!(wide > least && wide < end)) return {};
            }
            return static_cast<T>(value);
        },
        number);
}

/// A number in the type that C gives an operation on both.
Value common(const Number& number, const Number& other) {
    return std::visit(
        [&](auto a, auto b) {
            return converted<std::common_type_t<decltype(a), decltype(b)>>(number);
        },
        number, other);
}

Value cast(const std::string& type, const Number& number) {
    if (type == "int") return converted<cl_int>(number);
    if (type == "uint") return converted<cl_uint>(number);
    if (type == "long") return converted<cl_long>(number);
    if (type == "ulong") return converted<cl_ulong>(number);
    return converted<cl_float>(number);
}

Value value_of(const Node& node, const Values& values);

Number type_of(const Node& node, const Values& any) {
    const auto operand = [&](std::size_t i) { return type_of(node.operands[i], any); };
    switch (node.kind) {
        case Node::Kind::member:
            return member(node.text, any);
        case Node::Kind::literal:
            return node.literal;
        case Node::Kind::minus:
        case Node::Kind::complement:
            return operand(0);
        case Node::Kind::negation:
            return cl_int{0};
        case Node::Kind::cast:
            return *cast(node.text, cl_int{0});
        case Node::Kind::condition:
            return *common(std::visit([](auto x) -> Number { return x * 0; }, operand(1)),
                           operand(2));
        case Node::Kind::binary:
            break;
    }
    if (node.text == "&&" || node.text == "||" || node.text.find_first_of("<>=!") == 0)
        return cl_int{0};
    return *common(std::visit([](auto x) -> Number { return x * 0; }, operand(0)), operand(1));
}

Value value_of_condition(const Node& node, const Values& values) {
    const Value condition = value_of(node.operands[0], values);
    if (!condition) return {};
    const std::size_t chosen = is_true(*condition) ? 1 : 2;
    const Value value = value_of(node.operands[chosen], values);
    if (!value) return {};
    return common(*value, type_of(node.operands[3 - chosen], {}));
}

Value value_of_logic(const Node& node, const Values& values) {
    const Value a = value_of(node.operands[0], values);
    if (!a) return {};
    const bool ends = node.text == "&&" ? !is_true(*a) : is_true(*a);
    if (ends) return cl_int{node.text == "||"};
    const Value b = value_of(node.operands[1], values);
    if (!b) return {};
    return cl_int{is_true(*b)};
}

Value value_of(const Node& node, const Values& values) {
    if (node.kind == Node::Kind::member) return member(node.text, values);
    if (node.kind == Node::Kind::literal) return node.literal;
    if (node.kind == Node::Kind::condition) return value_of_condition(node, values);
    if (node.text == "&&" || node.text == "||") return value_of_logic(node, values);
    const Value a = value_of(node.operands[0], values);
    if (!a) return {};
    if (node.kind == Node::Kind::cast) return cast(node.text, *a);
    if (node.kind == Node::Kind::negation) return cl_int{!is_true(*a)};
    if (node.kind == Node::Kind::complement)
        return std::visit(
            [](auto x) -> Value {
                if constexpr (std::integral<decltype(x)>)
                    return static_cast<decltype(x)>(~x);
                else
                    return {};
            },
            *a);
    if (node.kind == Node::Kind::minus)
        return std::visit(
            [](auto x) -> Value {
                if constexpr (std::integral<decltype(x)>)
                    return arithmetic('-', decltype(x){0}, x);
                else
                    return -x;
            },
            *a);
    const Value b = value_of(node.operands[1], values);
    if (!b) return {};
    const Value x = common(*a, *b), y = common(*b, *a);
    if (!x || !y) return {};
    return std::visit(
        [&](auto first) { return binary(node.text, first, std::get<decltype(first)>(*y)); }, *x);
}

bool before(const Number& a, const Number& b) {
    return std::visit(
        [&](auto x) {
            const auto y = std::get<decltype(x)>(b);
            if constexpr (std::floating_point<decltype(x)>)
                return std::tuple(x, !std::signbit(x)) < std::tuple(y, !std::signbit(y));
            else
                return x < y;
        },
        a);
}

/// The records of a cell in order; none where a key is undefined.
std::optional<std::vector<Values>> sorted(const std::vector<Values>& records,
                                          const Node& expression, Order order) {
    std::vector<std::pair<Number, Values>> keyed;
    for (const Values& values : records) {
        const Value key = value_of(expression, values);
        if (!key) return {};
        keyed.emplace_back(*key, values);
    }
    std::sort(keyed.begin(), keyed.end(), [&](const auto& a, const auto& b) {
        const auto& [x, y] = order == Order::ascending ? std::tie(a, b) : std::tie(b, a);
        if (before(x.first, y.first)) return true;
        if (before(y.first, x.first)) return false;
        return members(a.second) < members(b.second);
    });
    std::vector<Values> out;
    for (const auto& [key, values] : keyed) out.push_back(values);
    return out;
}

// ---- what must hold

bool same(std::span<const Values> a, const std::vector<Values>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](const Values& x, const Values& y) { return members(x) == members(y); });
}

/// Every record is there, whatever its place.
void require_whole(const Lists<Values>& lists) {
    CELLIST_FUZZ_REQUIRE(lists.validate().ok());
    const auto by_members = [](const Values& a, const Values& b) {
        return members(a) < members(b);
    };
    const HostLists<Values> found = lists.download();
    for (std::size_t cell = 0; cell < cells; ++cell) {
        const auto list = found.cell(cell);
        std::vector<Values> in_order(list.begin(), list.end()), expected = records()[cell];
        std::sort(in_order.begin(), in_order.end(), by_members);
        std::sort(expected.begin(), expected.end(), by_members);
        CELLIST_FUZZ_REQUIRE(same(in_order, expected));
    }
}

/// Whether a text without "&&" has * or & without an operand before it, or next to a type or a
/// bracket.
bool uses_pointers(std::string text) {
    const std::string blanks = "[ \t\r\n]*", before = "(^|[^\\w)\\] \t\r\n])" + blanks;
    const std::string type =
        "\\b(?:bool|char|const|double|float|half|int|long|short|signed|size_t|uchar|uint|ulong|"
        "unsigned|ushort|void|volatile)(?:2|3|4|8|16)?\\b";
    // A call or an index stands behind an operand, a cast does not.
    static const std::regex cast(before + "\\(" + blanks + "(?:" + type + blanks + ")*\\)");
    for (std::string last; last != text;) {
        last = text;
        text = std::regex_replace(text, cast, "$1?");
    }
    static const std::regex refused(before + "[*&]|" + type + blanks + "[*&]|[*&]" + blanks +
                                    "(?:" + type + "|[)\\]])");
    return std::regex_search(text, refused);
}

/// Whether a text is refused before the compiler sees it: the same rule in other words.
bool is_refused(const std::string& text) {
    if (text.size() > 1024 || text.find_first_not_of(" \t\r\n") == std::string::npos) return true;
    static const std::regex allowed("[\\w\\s+\\-*/%&|^~!<>=?:.,()\\[\\]]*");
    static const std::regex refused(
        "//|/\\*|\\?\\?|<%|%>|%:|<:|:>|->|\\+\\+|--|[-+*/%&|^]=|<<=|>>=");
    static const std::regex refused_names(
        "\\b(?:(?:asm|barrier|cellist_sort_key|fract|frexp|lgamma_r|modf|prefetch|printf|remquo|"
        "sincos)\\b|__|async_|atom_|atomic_|cellist_insert|(?:read_|write_)?mem_fence|vstore|"
        "wait_group|work_group|write_image)");
    if (text.find_first_of("\v\f") != std::string::npos) return true;
    if (!std::regex_match(text, allowed) || std::regex_search(text, refused)) return true;
    // Members may have any name, and comparisons are no assignments.
    std::string plain = std::regex_replace(text, std::regex("\\b[0-9]\\w*\\."), "1 ");
    plain = std::regex_replace(plain, std::regex("\\.[ \t\r\n]*\\w+"), ".m");
    if (std::regex_search(plain, refused_names)) return true;
    plain = std::regex_replace(plain, std::regex("[=!<>]=|&&"), "?");
    if (plain.find('=') != std::string::npos) return true;
    if (uses_pointers(plain)) return true;
    std::string brackets;
    for (const char c : text)
        if (std::string_view("()[]").find(c) != std::string_view::npos) brackets += c;
    for (std::size_t length = brackets.size() + 1; brackets.size() < length;) {
        length = brackets.size();
        for (const char* pair : {"()", "[]"})
            if (const auto at = brackets.find(pair); at != std::string::npos) brackets.erase(at, 2);
    }
    return !brackets.empty();
}

bool check_refuses(const std::string& text) {
    try {
        detail::check_expression(text);
        return false;
    } catch (const Error&) {
        return true;
    }
}

void sort_by_any_text(Lists<Values>& lists, const std::string& text) {
    CELLIST_FUZZ_REQUIRE(check_refuses(text) == is_refused(text));
    try {
        lists.sort_by(text);
    } catch (const Error& error) {
        CELLIST_FUZZ_REQUIRE(error.what()[0] != '\0');
        CELLIST_FUZZ_REQUIRE(is_refused(text) ==
                             (dynamic_cast<const OpenClError*>(&error) == nullptr));
    }
    require_whole(lists);
}

void sort_by_grammar(Lists<Values>& lists, Input& input) {
    const Order order = input.below(2) == 0 ? Order::ascending : Order::descending;
    const Node expression = take_node(input, 4);
    const std::string text = text_of(expression, input);
    if (text.size() > 1024) {
        CELLIST_FUZZ_REQUIRE(check_refuses(text));
        return;
    }
    lists.sort_by(text, order);
    require_whole(lists);
    const HostLists<Values> found = lists.download();
    for (std::size_t cell = 0; cell < cells; ++cell)
        if (const auto expected = sorted(records()[cell], expression, order))
            if (!same(found.cell(cell), *expected)) {
                std::fprintf(stderr, "sorted wrongly by %s\n", text.c_str());
                std::abort();
            }
}

void run(Input& input) {
    static std::unique_ptr<Lists<Values>> lists[storages];
    bool is_new = false;
    const Device& on = device(is_new);
    if (is_new)
        for (std::size_t i = 0; i < storages; ++i)
            lists[i] = make_lists(on, static_cast<Storage>(i));
    if (input.below(256) == 'g') {
        Lists<Values>& chosen = *lists[input.below(storages)];
        sort_by_grammar(chosen, input);
    } else {
        const std::string text = input.rest();
        sort_by_any_text(*lists[text.size() % storages], text);
    }
}

}  // namespace
}  // namespace cellist::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    cellist::fuzz::Input input(data, size);
    cellist::fuzz::run(input);
    return 0;
}
