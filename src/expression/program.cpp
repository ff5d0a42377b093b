// SPDX-License-Identifier: MIT
#include "expression/program.hpp"

#include <algorithm>
#include <cctype>

#include <cellist/error.hpp>

#include "expression/expression.hpp"

namespace cellist::detail {

namespace {

/// An expression with the meanings of its subjects in the place of their names.
std::string with_meanings(std::string_view expression, const std::vector<Subject>& subjects) {
    std::string text;
    char before = ' ';  // the last character that is no blank
    for (std::size_t at = 0; at < expression.size();) {
        std::size_t end = at + 1;
        if (in_name(expression[at]))
            while (end < expression.size() && in_name(expression[end])) ++end;
        const std::string_view part = expression.substr(at, end - at);
        const auto subject =
            std::find_if(subjects.begin(), subjects.end(),
                         [&](const Subject& candidate) { return candidate.name == part; });
        text += subject != subjects.end() && before != '.' ? subject->meaning : std::string(part);
        if (std::isspace(static_cast<unsigned char>(part.back())) == 0) before = part.back();
        at = end;
    }
    return text;
}

/// Adds the struct cellist_values. It has no use without values, but needs a member.
void add_values(const Values& values, ExpressionProgram& program) {
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

/// The definition of a function, which knows the values by their names.
std::string definition_of(const ExpressionFunction& function, const Values& values) {
    const bool is_evaluated = function.unevaluated.empty();
    std::string names = function.unevaluated;
    for (const Value& value : values) {
        const std::string name = value.type() + " " + value.name();
        names += is_evaluated ? "    const " + name + " = cellist_given." + value.name() + ";\n"
                              : "    " + name + ";\n";
    }
    const std::string line = "#line 1 \"" + function.what + "\"\n";
    // Where clang knows that a value is undefined, it is an error: the kernel around it would be
    // undefined as well.
    return "#ifdef __clang__\n#pragma clang diagnostic push\n"
           "#pragma clang diagnostic error \"-Wdivision-by-zero\"\n"
           "#pragma clang diagnostic error \"-Warray-bounds\"\n#endif\n"
           "#line 1 \"values of the " +
           function.what + "\"\n" + function.head +
           (is_evaluated ? "const cellist_values cellist_given" : "void") + ") {\n" + names + line +
           "return " + function.before + "(\n" + line +
           with_meanings(function.expression, function.subjects) + "\n)" + function.after +
           "; }\n#ifdef __clang__\n#pragma clang diagnostic pop\n#endif\n";
}

}  // namespace

bool in_name(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

void check_values(const Values& values, const std::vector<Subject>& subjects) {
    std::size_t bytes = 0;
    for (auto value = values.begin(); value != values.end(); ++value) {
        check_value_name(value->name());
        if (std::any_of(subjects.begin(), subjects.end(),
                        [&](const Subject& subject) { return subject.name == value->name(); }))
            throw Error("a value of an expression is called '" + value->name() +
                        "', which is reserved: rename it");
        if (std::any_of(values.begin(), value,
                        [&](const Value& other) { return other.name() == value->name(); }))
            throw Error("two values of an expression are called '" + value->name() +
                        "': rename one");
        bytes = round_up(bytes, value->alignment()) + value->bytes().size();
    }
    if (bytes > values_bytes_max)
        throw Error("the values of an expression take " + std::to_string(bytes) +
                    " bytes, which exceeds the limit of " + std::to_string(values_bytes_max) +
                    ": compute the expression in a kernel, and keep it in a member");
}

ExpressionProgram expression_program(const Values& values,
                                     const std::vector<ExpressionFunction>& functions) {
    ExpressionProgram program;
    add_values(values, program);
    for (const ExpressionFunction& function : functions)
        program.source += definition_of(function, values);
    return program;
}

}  // namespace cellist::detail
