// SPDX-License-Identifier: MIT
// The files in which the library keeps compiled programs: whatever else stands in their place, or
// happens to the folder, counts as no file.
#include "device/program_files.hpp"

#include <chrono>
#include <csignal>
#include <fstream>
#include <iterator>
#include <vector>

#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "device/sha256.hpp"
#include "support/cache.hpp"
#include "support/catch.hpp"

namespace cellist::test {
namespace {

namespace fs = std::filesystem;
using detail::ProgramFiles;
using detail::StoredProgram;

DeviceInfo some_device() {
    DeviceInfo info;
    info.name = "A device";
    info.platform = "Some platform";
    info.version = "OpenCL 3.0";
    info.driver = "1.2";
    return info;
}

const StoredProgram some_program{"a warning\n", std::string("binary\0of 3 lines\n\n", 18)};

bool has(const ProgramFiles& files, const std::string& key, const StoredProgram& program) {
    const auto found = files.load(key);
    return found && found->log == program.log && found->binary == program.binary;
}

std::string content(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

void write(const fs::path& path, const std::string& text) {
    std::ofstream(path, std::ios::binary) << text;
}

TEST_CASE("digests are those of FIPS 180-4") {
    REQUIRE(detail::sha256("") ==
            "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
    REQUIRE(detail::sha256("abc") ==
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    REQUIRE(detail::sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq") ==
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
    REQUIRE(detail::sha256(std::string(1'000'000, 'a')) ==
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST_CASE("a program is stored and found again, by its key, device and driver") {
    const ProgramCacheDirectory cache;
    const ProgramFiles files(some_device());
    REQUIRE_FALSE(files.load("key"));
    files.store("key", some_program);
    REQUIRE(has(files, "key", some_program));
    REQUIRE(has(ProgramFiles(some_device()), "key", some_program));
    REQUIRE_FALSE(files.load("Key"));
    const StoredProgram other{"", "another"};
    files.store("key", other);
    REQUIRE(has(files, "key", other));
    REQUIRE(std::distance(fs::directory_iterator(cache.programs()), {}) == 1);
    REQUIRE((fs::status(cache.programs()).permissions() & fs::perms::all) == fs::perms::owner_all);
    for (std::string DeviceInfo::*part :
         {&DeviceInfo::name, &DeviceInfo::platform, &DeviceInfo::version, &DeviceInfo::driver}) {
        DeviceInfo device = some_device();
        device.*part += "x";
        REQUIRE_FALSE(ProgramFiles(device).load("key"));
    }
    const StoredProgram empty{};
    files.store("", empty);
    REQUIRE(has(files, "", empty));
}

TEST_CASE("a file that is truncated, garbled, or another program's is none") {
    const ProgramCacheDirectory cache;
    const ProgramFiles files(some_device());
    files.store("key", some_program);
    const fs::path path = *files.path_of("key");
    const std::string text = content(path);
    for (std::size_t size = 0; size < text.size(); ++size) {
        write(path, text.substr(0, size));
        REQUIRE_FALSE(files.load("key"));
    }
    for (std::size_t at = 0; at < text.size(); ++at)
        for (const int bit : {1, 128}) {
            std::string garbled = text;
            garbled[at] = static_cast<char>(garbled[at] ^ bit);
            write(path, garbled);
            REQUIRE_FALSE(files.load("key"));
        }
    for (const std::string& added : {text + "x", "x" + text, text + text, std::string(100, '9')}) {
        write(path, added);
        REQUIRE_FALSE(files.load("key"));
    }
    files.store("another key", some_program);
    fs::copy_file(*files.path_of("another key"), path, fs::copy_options::overwrite_existing);
    REQUIRE_FALSE(files.load("key"));
    // A sum that fits does not make sizes that do not.
    for (const std::string sizes : {"10 19", "11 18", "9 18", "18446744073709551615 29", "-1 29",
                                    "10", "10 18446744073709551614"}) {
        const std::string changed =
            text.substr(0, text.find("10 18\n")) + sizes + text.substr(text.find("10 18\n") + 5);
        const std::string summed = changed.substr(0, changed.size() - 64);
        write(path, summed + detail::sha256(summed));
        INFO(sizes);
        REQUIRE_FALSE(files.load("key"));
    }
    files.store("key", some_program);
    REQUIRE(has(files, "key", some_program));
}

TEST_CASE("what is no file does no harm in the place of one") {
    const ProgramCacheDirectory cache;
    const ProgramFiles files(some_device());
    fs::create_directories(cache.programs());
    const fs::path path = *files.path_of("key");
    REQUIRE(mkfifo(path.c_str(), 0600) == 0);
    REQUIRE_FALSE(files.load("key"));
    fs::remove(path);
    fs::create_directories(path / "full");
    REQUIRE_FALSE(files.load("key"));
    files.store("key", some_program);
    REQUIRE_FALSE(files.load("key"));
    REQUIRE(std::distance(fs::directory_iterator(cache.programs()), {}) == 1);
}

TEST_CASE("where no file can be written, none is there") {
    const ProgramCacheDirectory cache;
    const auto keeps_nothing = [] {
        const ProgramFiles files(some_device());
        files.store("key", some_program);
        return !files.load("key");
    };
    write(cache.path / "cellist", "a file in the place of the folder");
    REQUIRE(keeps_nothing());
    REQUIRE(content(cache.path / "cellist").starts_with("a file"));
    for (const char* chosen : {"/dev/null", "/dev/full", "/proc/cellist", "/proc/version/x"}) {
        const Variable variable("CELLIST_PROGRAM_CACHE", chosen);
        REQUIRE(keeps_nothing());
    }
    const Variable no_cache("XDG_CACHE_HOME", nullptr);
    const Variable no_home("HOME", nullptr);
    REQUIRE(keeps_nothing());
}

TEST_CASE("a folder that may only be read gives its programs") {
    const ProgramCacheDirectory cache;
    const ProgramFiles files(some_device());
    files.store("key", some_program);
    fs::permissions(cache.programs(), fs::perms::owner_read | fs::perms::owner_exec);
    REQUIRE(has(files, "key", some_program));
    files.store("another", some_program);  // by root, this succeeds
    REQUIRE(has(files, "key", some_program));
    fs::permissions(cache.programs(), fs::perms::owner_all);
}

TEST_CASE("a full file system leaves no part of a file") {
    const ProgramCacheDirectory cache;
    const ProgramFiles files(some_device());
    files.store("key", some_program);
    rlimit old{};
    REQUIRE(getrlimit(RLIMIT_FSIZE, &old) == 0);
    const auto handler = std::signal(SIGXFSZ, SIG_IGN);
    const rlimit small{1000, old.rlim_max};
    REQUIRE(setrlimit(RLIMIT_FSIZE, &small) == 0);
    files.store("large", {"", std::string(100'000, 'x')});
    files.store("key", {"", std::string(100'000, 'x')});
    REQUIRE(setrlimit(RLIMIT_FSIZE, &old) == 0);
    std::signal(SIGXFSZ, handler);
    REQUIRE_FALSE(files.load("large"));
    REQUIRE(has(files, "key", some_program));
    REQUIRE(std::distance(fs::directory_iterator(cache.programs()), {}) == 1);
}

TEST_CASE("CELLIST_PROGRAM_CACHE moves the folder or turns it off") {
    const ProgramCacheDirectory cache;
    const fs::path elsewhere = cache.path / "else where";
    {
        const Variable variable("CELLIST_PROGRAM_CACHE", elsewhere.c_str());
        const ProgramFiles files(some_device());
        files.store("key", some_program);
        REQUIRE(has(files, "key", some_program));
        REQUIRE(fs::exists(elsewhere));
    }
    for (const char* off : {"off", ""}) {
        const Variable variable("CELLIST_PROGRAM_CACHE", off);
        const ProgramFiles files(some_device());
        files.store("key", some_program);
        REQUIRE_FALSE(files.load("key"));
        REQUIRE_FALSE(files.path_of("key"));
    }
    REQUIRE_FALSE(fs::exists(cache.path / "cellist"));
}

TEST_CASE("the files that were used least recently go first") {
    const ProgramCacheDirectory cache;
    const StoredProgram large{"", std::string(1000, 'x')};
    const ProgramFiles unbounded(some_device());
    unbounded.store("0", large);
    const std::uint64_t bytes = fs::file_size(*unbounded.path_of("0"));
    const ProgramFiles files(some_device(), 3 * bytes);
    const auto age = [&](const std::string& key, int minutes) {
        fs::last_write_time(*files.path_of(key),
                            fs::file_time_type::clock::now() - std::chrono::minutes(minutes));
    };
    files.store("1", large);
    files.store("2", large);
    age("0", 30);
    age("1", 20);
    age("2", 10);
    REQUIRE(files.load("0"));  // and now it is the last one
    files.store("3", large);
    REQUIRE(files.load("0"));
    REQUIRE_FALSE(files.load("1"));
    REQUIRE(files.load("2"));
    REQUIRE(files.load("3"));
    files.store("huge", {"", std::string(4 * bytes, 'x')});
    REQUIRE_FALSE(files.load("huge"));
    REQUIRE(files.load("3"));

    // Other files stay, but for those of processes that were killed while they wrote one.
    const fs::path other = cache.programs() / "notes.txt";
    const fs::path abandoned = fs::path(*files.path_of("3")) += ".123";
    const fs::path unfinished = fs::path(*files.path_of("3")) += ".456";
    for (const fs::path& path : {other, abandoned, unfinished}) write(path, "text");
    for (const fs::path& path : {other, abandoned})
        fs::last_write_time(path, fs::file_time_type::clock::now() - std::chrono::hours(2));
    files.store("4", large);
    REQUIRE(fs::exists(other));
    REQUIRE_FALSE(fs::exists(abandoned));
    REQUIRE(fs::exists(unfinished));
}

TEST_CASE("processes that store and load at once find whole programs or none") {
    const ProgramCacheDirectory cache;
    constexpr int keys = 5;
    const auto program = [](int key) {
        return StoredProgram{std::to_string(key),
                             std::string(20'000, static_cast<char>('a' + key))};
    };
    const auto work = [&](int seed) {
        // Room for three: the processes remove each other's files all the time.
        const ProgramFiles files(some_device(), 65'000);
        for (int i = 0; i < 300; ++i) {
            const int key = (i * 7 + seed) % keys;
            const auto found = files.load(std::to_string(key));
            if (found && (found->log != program(key).log || found->binary != program(key).binary))
                return 1;
            files.store(std::to_string(key), program(key));
        }
        return 0;
    };
    std::vector<pid_t> children;
    for (int i = 0; i < 3; ++i) {
        const pid_t child = fork();
        REQUIRE(child >= 0);
        if (child == 0) _exit(work(i));
        children.push_back(child);
    }
    for (const pid_t child : children) {
        int status = -1;
        REQUIRE(waitpid(child, &status, 0) == child);
        REQUIRE(status == 0);
    }
    for (const auto& entry : fs::directory_iterator(cache.programs()))
        REQUIRE(entry.path().extension() == ".program");
}

}  // namespace
}  // namespace cellist::test
