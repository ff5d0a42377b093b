// SPDX-License-Identifier: MIT
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
    check_expression(key.expression, key.what);
    check_values(key.values, key_subjects());
}

ExpressionProgram key_program(const SortKey& key) {
    const std::string type = key.bits == 32 ? "uint" : "ulong";
    const std::string pointer = "global const CELLIST_RECORD_TYPE* cellist_sort_at";
    return expression_program(
        key.values, {{.expression = key.expression,
                      .what = key.what,
                      .head = "static inline " + type + " cellist_sort_key(" + pointer + ",\n    ",
                      .before = "(" + type + ")" + (key.order == Order::descending ? "~" : "") +
                                "cellist_order",
                      .subjects = key_subjects()},
                     {.expression = key.expression,
                      .what = key.what,
                      .head = "static inline uint cellist_sort_key_bytes(",
                      .before = "(uint)sizeof",
                      .subjects = key_subjects(),
                      .unevaluated = "    " + pointer + ";\n"}});
}

std::string tie_function(const SortKey& key, const RecordType& record) {
    constexpr std::size_t scalars_max = 8;
    std::string text =
        "static inline uint cellist_sort_word(global const CELLIST_RECORD_TYPE* record, "
        "uint word) {\n";
    std::size_t scalars = 0;
    for (const RecordMember& member : record.members) {
        if (member.is_scalar && key.expression == "record" + member.scalars.front()) continue;
        for (const std::string& path : member.scalars) {
            if (scalars++ == scalars_max) break;
            const std::string scalar = "(*record)" + path;
            const std::string words = "cellist_words_of(" + scalar + ")";
            text += "if (word < " + words + ") return cellist_word_of(" + scalar +
                    ", word);\nword -= " + words + ";\n";
        }
    }
    return text + "return 0;\n}\n";
}

bool is_member(const SortKey& key) {
    constexpr std::string_view prefix = "record.";
    if (key.expression == "record") return true;
    return key.expression.starts_with(prefix) &&
           std::all_of(key.expression.begin() + prefix.size(), key.expression.end(), in_name);
}

}  // namespace cellist::detail
