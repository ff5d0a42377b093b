// SPDX-License-Identifier: MIT
// The expression of sort_by is one expression and nothing else, whatever it holds.
#include "support/errors.hpp"
#include "support/inserts.hpp"

namespace cellist::test {
namespace {

struct Samples {
    cl_float key;
    cl_uint id;
    cl_short values[2];
};
CELLIST_STRUCT(Samples, key, id, values);

/// 100 records with ids from 0 up, in 3 cells.
class SampleLists {
public:
    SampleLists() : lists_(device(), {3}) {
        for (cl_uint i = 0; i < 100; ++i)
            inserts_.add(i % 3, {1.0f, i, {static_cast<cl_short>(i), 7}});
        Inserter(lists_).build(lists_, inserts_);
    }

    Lists<Samples>& operator*() { return lists_; }

    /// No record is lost, and the lists can be sorted.
    void require_usable() {
        require_sound(lists_, 100);
        require_same(lists_.download(), oracle_of(inserts_, 3));
        lists_.sort(&Samples::id);
        for (std::uint64_t cell = 0; cell < 3; ++cell)
            REQUIRE(lists_.download().cell(cell)[5].id == cell + 15);
    }

private:
    Lists<Samples> lists_;
    Inserts<Samples> inserts_;
};

TEST_CASE("what is not one expression is refused, and what is wrong with it is named") {
    SampleLists lists;
    for (const auto& [expression, named] : {
             std::pair<std::string, std::string>{"0); } kernel void x(void) { (1", "unmatched ')'"},
             {"0; } kernel void x(void) { 1", "';'"},
             {"1) + (2", "unmatched ')'"},
             {"record.values[0)", "unmatched ')'"},
             {"(record.id", "no ')'"},
             {"record.values[0", "no ']'"},
             {"({ for (;;) ; 1; })", "'{'"},
             {"(int[]){1, 2}[0]", "'{'"},
             {"^{ return 1; }()", "'{'"},
             {"record.id /*", "'/*'"},
             {"record.id // last", "'//'"},
             {"record.id \\", "'\\'"},
             {"record.id ?\?/", "'?\?'"},
             {"1\n#undef kernel\n", "'#'"},
             {"1\n%:undef kernel\n", "'%:'"},
             {"(<% for (;;) ; 1; %>)", "'<%'"},
             {"\"text\"[0]", "'\"'"},
             {"'a'", "'''"},
             {std::string("record.id\0", 10), "byte of 0"},
             {"record.id \xC2\xB2", "byte of 194"},
             {"cellist_sort_key(record)", "'cellist_sort_key'"},
             {"(barrier(CLK_LOCAL_MEM_FENCE), 1)", "'barrier'"},
             {"record.id = 3", "'='"},
             {"(record.id += 3)", "'+='"},
             {"record.id <<= 3", "'<<='"},
             {"record.id++", "'++'"},
             {"- --record.id", "'--'"},
             {"*record.values", "'*'"},
             {"1 + *(record.values + 9)", "'*'"},
             {"(float)*record.values", "'*'"},
             {"(unsigned int)&record", "'&'"},
             {"&record == 0", "'&'"},
             {"record.id & &record", "'&'"},
             {"record.id ? *record.values : 1", "'*'"},
             {"((global uint*)16)[0]", "'*'"},
             {"((uint * const)16)[0]", "'*'"},
             {"((struct Samples*)0)->id", "'*'"},
             {"((struct Samples * const)0)[0].id", "'const'"},
             {"(record.values)->x", "'->'"},
             {"atomic_inc(record.values)", "'atomic_inc'"},
             {"atom_add(record.values, 1)", "'atom_add'"},
             {"(vstore2((short2)(1), 0, record.values), 1)", "'vstore2'"},
             {"frexp(record.key, record.values)", "'frexp'"},
             {"(printf(0), 1)", "'printf'"},
             {"__builtin_trap()", "'__builtin_trap'"},
             {std::string(10'000, '~') + "record.id", "10009"},
         }) {
        INFO(expression.substr(0, 100));
        const auto error = error_of([&, &text = expression] { (*lists).sort_by(text); });
        INFO(error.what());
        REQUIRE(contains(error.what(), named));
        REQUIRE_FALSE(contains(error.what(), "clBuildProgram"));
    }
    lists.require_usable();
}

TEST_CASE("expressions may have brackets, calls, several lines and any operators") {
    SampleLists lists;
    for (const std::string expression :
         {"max((int)record.id, 3) >= 4 ? record.values[record.id & 1] : -(~7 << 2)",
          "((((record.id))))", "record.id\n  % 3\n",
          "dot((float2)(record.key, 1.5e+1f), (float2)(1))", "record . key",
          "record.id<1||!record.id&&1", "sizeof(record) ^ 0x1Ful",
          "(record.id)*(record.id) & (record.id) | (uint)(2)*3 ^ sizeof(uint)*4",
          "(record.id >= 3) == (record.id != 4) || record.id <= 5",
          "record.values[0]*2 + max(1, 2)*3", "(float)-record.key < - -1", "1.*record.key"}) {
        INFO(expression);
        (*lists).sort_by(expression);
    }
    (*lists).sort_by(std::string(1014, '~') + " record.id");
    lists.require_usable();
}

TEST_CASE("a value that is known to be undefined does not lose records") {
    SampleLists lists;
    for (const std::string expression :
         {"record.id / 0", "record.id % (3 - 3)", "record.values[2]"}) {
        INFO(expression);
        try {
            (*lists).sort_by(expression);
        } catch (const OpenClError&) {
            // Compilers may refuse it.
        }
        lists.require_usable();
    }
}

}  // namespace
}  // namespace cellist::test
