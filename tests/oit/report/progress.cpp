// SPDX-License-Identifier: MIT
// Long work says how far it is without a terminal, too, in lines now and then.
#include "progress.hpp"

#include <thread>

#include "support/catch.hpp"
#include "support/errors.hpp"

namespace cellist::test {
namespace {

using std::chrono::milliseconds;

// What is printed for 100 updates.
std::string printed(milliseconds first) {
    std::FILE* file = std::tmpfile();
    REQUIRE(file != nullptr);
    {
        support::Progress progress("work", file, first);
        for (int i = 0; i < 100; ++i) {
            progress.update(0.01 * i);
            std::this_thread::sleep_for(milliseconds(1));
        }
    }
    std::string text(static_cast<std::size_t>(std::ftell(file)), '\0');
    std::rewind(file);
    REQUIRE(std::fread(text.data(), 1, text.size(), file) == text.size());
    std::fclose(file);
    return text;
}

TEST_CASE("short work prints nothing") { CHECK(printed(std::chrono::hours(1)).empty()); }

TEST_CASE("long work prints lines, ever more seldom") {
    const std::string text = printed(milliseconds(2));
    CHECK(text.starts_with("work "));
    CHECK(text.ends_with(" %\n"));
    CHECK_FALSE(contains(text, "\r"));
    // At 2, 4, 7, 11, ... ms, of the 100 and more that it takes.
    CHECK(count_of(text, "\n") >= 2);
    CHECK(count_of(text, "\n") <= 30);
}

}  // namespace
}  // namespace cellist::test
