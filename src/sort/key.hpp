#pragma once

#include <string>

#include <cellist/detail/arguments.hpp>
#include <cellist/detail/lists_core.hpp>
#include <cellist/detail/record_type.hpp>

namespace cellist::detail {

/// The most bytes of all values of an expression. Devices may limit the parameters of a kernel to
/// 1,024 bytes.
constexpr std::size_t values_bytes_max = 512;

/// What a kernel needs to compute a key.
struct KeyProgram {
    std::string source;  ///< defines cellist_values and cellist_sort_key(pointer, values)
    Definitions types;   ///< of the values
    Arguments values;    ///< one: a cellist_values
};

/// Throws Error unless the expression is one (see check_expression) and its values have valid names
/// and at most values_bytes_max bytes.
void check_key(const SortKey& key);

/// Of a key that check_key() accepts.
[[nodiscard]] KeyProgram key_program(const SortKey& key);

/// Whether a key is the value of a member, which is the same whenever it is read.
[[nodiscard]] bool is_member(const SortKey& key);

}  // namespace cellist::detail
