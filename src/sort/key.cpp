#include "sort/key.hpp"

#include <algorithm>
#include <string_view>

#include "expression/expression.hpp"

namespace cellist::detail {

namespace {

/// The expression reads the record through a pointer. A private copy of a large record would take
/// too much memory.
const std::vector<Subject>& key_subjects() {
    static const std::vector<Subject> all{{"record", "(*cellist_sort_at)"}};
    return all;
}

}  // namespace

void check_key(const SortKey& key) {
    check_expression(key.expression);
    check_values(key.values, key_subjects());
}

ExpressionProgram key_program(const SortKey& key) {
    const std::string type = key.bits == 32 ? "uint" : "ulong";
    return expression_program(
        key.values,
        {{.expression = key.expression,
          .what = "sort expression",
          .head = "static inline " + type +
                  " cellist_sort_key(global const struct CELLIST_RECORD* cellist_sort_at,\n    ",
          .before =
              "(" + type + ")" + (key.order == Order::descending ? "~" : "") + "cellist_order",
          .subjects = key_subjects()}});
}

bool is_member(const SortKey& key) {
    constexpr std::string_view prefix = "record.";
    return key.expression.starts_with(prefix) &&
           std::all_of(key.expression.begin() + prefix.size(), key.expression.end(), in_name);
}

}  // namespace cellist::detail
