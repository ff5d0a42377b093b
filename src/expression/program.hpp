// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <cellist/detail/arguments.hpp>
#include <cellist/detail/record_type.hpp>
#include <cellist/value.hpp>

namespace cellist::detail {

/// The most bytes of all values of an expression. Devices may limit the parameters of a kernel to
/// 1,024 bytes.
constexpr std::size_t values_bytes_max = 512;

/// A name in an expression that is not a value, such as `record`, and what it stands for in OpenCL
/// C.
struct Subject {
    std::string name;
    std::string meaning;
};

/// An expression as a function of OpenCL C.
struct ExpressionFunction {
    std::string expression;
    std::string what;  ///< names the expression in the compiler's messages
    std::string head;  ///< up to the last parameter, e.g. "static inline float f(const float* x, "
    std::string before = {};  ///< comes before the expression, in the return statement
    std::string after = {};
    std::vector<Subject> subjects = {};
    /// Declares what the subjects mean, in a function without parameters, which does not evaluate
    /// the expression. Empty for the others.
    std::string unevaluated = {};
};

/// What a kernel needs to compute expressions.
struct ExpressionProgram {
    std::string source;  ///< defines cellist_values, the last parameter, and the functions
    Definitions types;   ///< of the values
    Arguments values;    ///< one: a cellist_values
};

/// Throws Error unless the values have different valid names, none of which is that of a subject,
/// and at most values_bytes_max bytes.
void check_values(const Values& values, const std::vector<Subject>& subjects);

/// Of expressions that check_expression() accepts, and values that check_values() accepts.
[[nodiscard]] ExpressionProgram expression_program(
    const Values& values, const std::vector<ExpressionFunction>& functions);

/// Whether a character may be part of a name.
[[nodiscard]] bool in_name(char c);

}  // namespace cellist::detail
