// SPDX-License-Identifier: MIT
// `cellist tune` as it is called: what it prints and writes, and how it refuses.
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <random>
#include <regex>

#include <sys/wait.h>

#include "device/profile.hpp"
#include "support/errors.hpp"
#include "support/skip.hpp"

namespace cellist::test {
namespace {

namespace fs = std::filesystem;

struct Result {
    int status = -1;
    std::string output;  ///< both streams
};

/// Runs `cellist` with the arguments, after assignments of environment variables.
Result run(const std::string& variables, const std::string& arguments) {
    Result result;
    const std::string line =
        "{ env " + variables + " '" CELLIST_COMMAND "' " + arguments + "; } 2>&1";
    FILE* pipe = popen(line.c_str(), "r");
    REQUIRE(pipe != nullptr);
    std::array<char, 1024> part{};
    while (const std::size_t size = std::fread(part.data(), 1, part.size(), pipe))
        result.output.append(part.data(), size);
    const int status = pclose(pipe);
    if (WIFEXITED(status)) result.status = WEXITSTATUS(status);
    return result;
}

TEST_CASE("tune prints a table, and writes a profile that can be read") {
    const fs::path cache =
        fs::temp_directory_path() / ("cellist-test-" + std::to_string(std::random_device{}()));
    const Result result = run("XDG_CACHE_HOME=" + cache.string(), "tune");
    INFO(result.output);
    REQUIRE(result.status == 0);
    for (const char* pattern : {"coherent", "random"})
        for (const char* storage : {"linked", "counted", "fixed"})
            REQUIRE(std::regex_search(result.output,
                                      std::regex(std::string(pattern) + " +" + storage +
                                                 " +[0-9]+\\.[0-9]{3} +[0-9]+\\.[0-9]{3}\n")));
    std::smatch where;
    REQUIRE(std::regex_search(result.output, where, std::regex("written to (.*)\n$")));
    const fs::path path = where[1].str();
    REQUIRE(path.parent_path() == cache / "cellist");
    std::ifstream file(path);
    const std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    INFO(text);
    REQUIRE(detail::parse_profile(Device::choose().info(), text).has_value());
    fs::remove_all(cache);
}

TEST_CASE("tune refuses before it measures") {
    struct Refusal {
        const char* variables;
        const char* arguments;
        int status;
        const char* message;
    };
    for (const auto& [variables, arguments, status, message] : {
             Refusal{"-u HOME -u XDG_CACHE_HOME", "tune", 1, "set XDG_CACHE_HOME or HOME"},
             Refusal{"HOME= XDG_CACHE_HOME=here", "tune", 1, "set XDG_CACHE_HOME or HOME"},
             Refusal{"XDG_CACHE_HOME=/dev/null", "tune", 1,
                     "cannot make the directory /dev/null/cellist"},
             Refusal{"A=B", "tune --device nosuch", 1, "no device is called 'nosuch'"},
             Refusal{"A=B", "tune --device", 2, "incomplete argument '--device'"},
             Refusal{"A=B", "tune --quick", 2, "argument '--quick'"},
             Refusal{"A=B", "tune 0", 2, "argument '0'"},
         }) {
        const Result result = run(variables, arguments);
        INFO(variables << " cellist " << arguments << ": " << result.output);
        REQUIRE(result.status == status);
        REQUIRE(contains(result.output, message));
        REQUIRE_FALSE(contains(result.output, "written to"));
    }
}

TEST_CASE("tune refuses before it measures where the profile cannot be written") {
    const fs::path cache =
        fs::temp_directory_path() / ("cellist-test-" + std::to_string(std::random_device{}()));
    // A folder has the profile's name.
    const DeviceInfo info = Device::choose().info();
    setenv("XDG_CACHE_HOME", cache.c_str(), 1);
    const fs::path path = detail::profile_path(info);
    fs::create_directories(path);
    const Result result = run("XDG_CACHE_HOME=" + cache.string(), "tune");
    INFO(result.output);
    REQUIRE(result.status == 1);
    REQUIRE(result.output == "cellist: cannot write " + path.string() + ": it is not a file\n");
    // And nothing else is left there.
    REQUIRE(std::distance(fs::directory_iterator(path.parent_path()), fs::directory_iterator()) ==
            1);
    fs::remove_all(cache);
}

TEST_CASE("a full disk behind the standard output ends every command with one line and status 1") {
    if (!fs::exists("/dev/full")) CELLIST_SKIP("there is no /dev/full");
    const fs::path cache =
        fs::temp_directory_path() / ("cellist-test-" + std::to_string(std::random_device{}()));
    for (const char* command : {"devices", "selftest", "tune", "--help", "--version"}) {
        const Result result =
            run("XDG_CACHE_HOME=" + cache.string(), std::string(command) + " >/dev/full");
        INFO(command << ": " << result.output);
        REQUIRE(result.status == 1);
        REQUIRE(result.output ==
                "cellist: cannot write to standard output: No space left on device\n");
    }
    fs::remove_all(cache);
}

}  // namespace
}  // namespace cellist::test
