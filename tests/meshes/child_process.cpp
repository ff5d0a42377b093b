// SPDX-License-Identifier: MIT
// Work in a child process ends with its result or with an error, whatever happens in it.
#include "child_process.hpp"

#include <cstdlib>
#include <functional>
#include <string>

#include "input_error.hpp"
#include "support/errors.hpp"

namespace cellist::test {
namespace {

constexpr support::ChildLimits small{1, std::uint64_t{1} << 28, 1 << 20};

std::string failure_of(const std::function<std::string()>& work) {
    return error_of<support::InputError>([&] { (void)support::run_in_child(work, small); }).what();
}

TEST_CASE("work in a child process gives its result, however long") {
    const std::string long_result(1 << 20, 'x');
    CHECK(support::run_in_child([&] { return long_result; }, {1, 1 << 28, 2 << 20}) == long_result);
    CHECK(support::run_in_child([] { return std::string(); }, small).empty());
}

TEST_CASE("a crash, an exit, a hang, an exception or too much memory in a child is an error") {
    CHECK(contains(failure_of([]() -> std::string { std::abort(); }), "crashed (Aborted)"));
    CHECK(contains(failure_of([]() -> std::string { std::_Exit(0); }), "without a result"));
    CHECK(contains(failure_of([]() -> std::string { throw support::InputError("odd"); }), "odd"));
    CHECK(contains(failure_of([] { return std::string(2 << 20, 'x'); }), "more than 1 MiB"));
    CHECK(contains(failure_of([]() -> std::string {
                       volatile bool forever = true;
                       while (forever) {}
                       return "";
                   }),
                   "took more than"));
#if !defined(__SANITIZE_ADDRESS__)
    CHECK(contains(failure_of([] { return std::string(std::size_t{1} << 30, 'x'); }), "256 MiB"));
#endif
}

}  // namespace
}  // namespace cellist::test
