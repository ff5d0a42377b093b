// SPDX-License-Identifier: MIT
#pragma once

#include <cellist/detail/lists_core.hpp>

#include "expression/program.hpp"

namespace cellist::detail {

/// Throws Error unless the expression is one (see check_expression) and its values are valid (see
/// check_values).
void check_key(const SortKey& key);

/// Defines cellist_values, cellist_sort_key and cellist_sort_key_bytes (see sort.cl), of a key that
/// check_key() accepts.
[[nodiscard]] ExpressionProgram key_program(const SortKey& key);

/// Defines cellist_sort_word (see sort.cl), for the first scalars of a record. A member that is the
/// key decides no ties.
[[nodiscard]] std::string tie_function(const SortKey& key, const RecordType& record);

/// Whether a key is the value of a member, or a scalar record, which is the same whenever it is
/// read.
[[nodiscard]] bool is_member(const SortKey& key);

}  // namespace cellist::detail
