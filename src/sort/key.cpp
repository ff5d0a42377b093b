#include "sort/key.hpp"

#include <algorithm>
#include <cctype>
#include <string_view>

#include <cellist/error.hpp>

#include "sort/expression.hpp"

namespace cellist::detail {

namespace {

bool in_name(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

/// An expression of `record`, rewritten to read the record through a pointer. A private copy of a
/// large record would take too much memory.
std::string of_pointer(std::string_view expression) {
    std::string text;
    char before = ' ';  // the last character that is no blank
    for (std::size_t at = 0; at < expression.size();) {
        std::size_t end = at + 1;
        if (in_name(expression[at]))
            while (end < expression.size() && in_name(expression[end])) ++end;
        const std::string_view part = expression.substr(at, end - at);
        text += part == "record" && before != '.' ? "(*cellist_sort_at)" : std::string(part);
        if (std::isspace(static_cast<unsigned char>(part.back())) == 0) before = part.back();
        at = end;
    }
    return text;
}

/// Adds the struct cellist_values. It has no use without values, but needs a member.
void add_values(const Values& values, KeyProgram& program) {
    RecordType type{.name = "cellist_values", .members = {}};
    std::vector<std::byte> bytes;
    const auto add = [&](const Value& value) {
        const std::size_t offset = round_up(bytes.size(), value.alignment());
        type.members.push_back({value.name(), value.type(), {}, offset, {}, false});
        type.alignment = std::max(type.alignment, value.alignment());
        bytes.resize(offset);
        bytes.insert(bytes.end(), value.bytes().begin(), value.bytes().end());
        value.define(program.types);
    };
    for (const Value& value : values) add(value);
    if (values.empty()) add({"cellist_none", cl_uint{0}});
    type.size = round_up(bytes.size(), type.alignment);
    bytes.resize(type.size);
    program.source += type.definition();
    program.values.append(Arguments::Kind::value, bytes.data(), bytes.size());
}

/// The function cellist_sort_key, which knows the values by their names.
std::string key_function(const SortKey& key) {
    const std::string type = key.bits == 32 ? "uint" : "ulong";
    std::string names;
    for (const Value& value : key.values)
        names += "    const " + value.type() + " " + value.name() + " = cellist_given." +
                 value.name() + ";\n";
    // Where clang knows that a value is undefined, it is an error: the sort around it would be
    // undefined as well.
    return "#ifdef __clang__\n#pragma clang diagnostic push\n"
           "#pragma clang diagnostic error \"-Wdivision-by-zero\"\n"
           "#pragma clang diagnostic error \"-Warray-bounds\"\n#endif\n"
           "#line 1 \"values of the sort expression\"\n"
           "static inline " +
           type +
           " cellist_sort_key(global const struct CELLIST_RECORD* cellist_sort_at,\n"
           "    const cellist_values cellist_given) {\n" +
           names + "#line 1 \"sort expression\"\nreturn (" + type + ")" +
           (key.order == Order::descending ? "~" : "") +
           "cellist_order(\n#line 1 \"sort expression\"\n" + of_pointer(key.expression) +
           "\n); }\n#ifdef __clang__\n#pragma clang diagnostic pop\n#endif\n";
}

}  // namespace

void check_key(const SortKey& key) {
    check_expression(key.expression);
    std::size_t bytes = 0;
    for (auto value = key.values.begin(); value != key.values.end(); ++value) {
        check_value_name(value->name());
        if (std::any_of(key.values.begin(), value,
                        [&](const Value& other) { return other.name() == value->name(); }))
            throw Error("two values of an expression are called '" + value->name() +
                        "': rename one");
        bytes = round_up(bytes, value->alignment()) + value->bytes().size();
    }
    if (bytes > values_bytes_max)
        throw Error("the values of an expression take " + std::to_string(bytes) +
                    " bytes, which exceeds the limit of " + std::to_string(values_bytes_max) +
                    ": compute the key in a kernel, and keep it in a member");
}

KeyProgram key_program(const SortKey& key) {
    KeyProgram program;
    add_values(key.values, program);
    program.source += key_function(key);
    return program;
}

bool is_member(const SortKey& key) {
    constexpr std::string_view prefix = "record.";
    return key.expression.starts_with(prefix) &&
           std::all_of(key.expression.begin() + prefix.size(), key.expression.end(), in_name);
}

}  // namespace cellist::detail
