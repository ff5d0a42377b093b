// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace cellist::detail {

/// Longest expression, in characters. Compilers follow nested operators by recursion: PoCL 3.1
/// overflows 8 MiB of stack at 3000 of them.
constexpr std::size_t expression_length_max = 1024;

/// Throws Error unless the text, put between brackets, is one expression or no valid source at all:
/// so that it cannot end the function around it, open a comment, define a macro, loop or call
/// itself. Also refuses syntax that writes or uses pointers: assignments, unary * and &, pointer
/// types, ->, atomics, and other functions that write. The device's compiler checks names and
/// types; nothing checks values and indices.
void check_expression(std::string_view text, const std::string& what = "expression");

/// Throws Error unless an expression can use a value of this name.
void check_value_name(std::string_view name);

}  // namespace cellist::detail
