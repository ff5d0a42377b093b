// SPDX-License-Identifier: MIT
// A file is written whole or not at all, and what is read has an end.
#include "files.hpp"

#include <thread>

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include "input_error.hpp"
#include "oit/support/program.hpp"

namespace cellist::test {
namespace {

namespace fs = std::filesystem;

// Writes past it fail, as on a full disk.
class FileSizeLimit {
public:
    explicit FileSizeLimit(rlim_t bytes) {
        support::prepare_output();
        getrlimit(RLIMIT_FSIZE, &old_);
        const rlimit limit{bytes, old_.rlim_max};
        setrlimit(RLIMIT_FSIZE, &limit);
    }
    ~FileSizeLimit() { setrlimit(RLIMIT_FSIZE, &old_); }
    FileSizeLimit(const FileSizeLimit&) = delete;
    FileSizeLimit& operator=(const FileSizeLimit&) = delete;

private:
    rlimit old_{};
};

std::size_t files_in(const fs::path& folder) {
    return static_cast<std::size_t>(
        std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

std::string write_error(const fs::path& path, std::string_view bytes) {
    try {
        support::write_file(path, bytes);
    } catch (const support::InputError& error) {
        return error.what();
    }
    return {};
}

TEST_CASE("a file that does not fit leaves the old one, and nothing else") {
    const Folder folder;
    const fs::path old = folder.write("old", "as it was");
    const std::string much(100'000, 'x');
    {
        const FileSizeLimit limit(8192);
        for (const fs::path& path : {old, folder / "new"})
            CHECK(write_error(path, much) ==
                  "cannot write '" + path.string() + "': File too large");
    }
    CHECK(read_file(old) == "as it was");
    CHECK(files_in(folder / ".") == 1);
    support::write_file(old, much);
    CHECK(read_file(old) == much);
    CHECK(files_in(folder / ".") == 1);
}

TEST_CASE("permissions stay, and links are followed") {
    const Folder folder;
    const fs::path file = folder.write("file", "old");
    REQUIRE(chmod(file.c_str(), 0640) == 0);
    fs::create_symlink("file", folder / "link");
    support::write_file(folder / "link", "new");
    CHECK(fs::is_symlink(folder / "link"));
    CHECK(read_file(file) == "new");
    CHECK(fs::status(file).permissions() == fs::perms{0640});
    fs::create_symlink("missing", folder / "to new");
    support::write_file(folder / "to new", "made");
    CHECK(read_file(folder / "missing") == "made");
    fs::create_symlink("circle", folder / "circle");
    CHECK(contains(write_error(folder / "circle", "x"), "cannot write"));
}

TEST_CASE("devices and FIFOs are written as they are") {
    CHECK(write_error("/dev/full", "x") == "cannot write '/dev/full': No space left on device");
    CHECK(write_error("/dev/null", "x").empty());
    CHECK(fs::is_character_file("/dev/null"));
    const Folder folder;
    const fs::path fifo = folder / "fifo";
    REQUIRE(mkfifo(fifo.c_str(), 0600) == 0);
    std::string got;
    std::thread reader([&] { got = read_file(fifo); });
    const std::string much(200'000, 'y');  // more than a pipe holds
    support::write_file(fifo, much);
    reader.join();
    CHECK(got == much);
    CHECK(fs::is_fifo(fifo));
}

TEST_CASE("names that mean stdout") {
    for (const char* name : {"-", "/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"})
        CHECK(support::is_standard_output(name));
    for (const char* name : {"", "./-", "/dev/stderr", "/dev/null", "stdout"})
        CHECK_FALSE(support::is_standard_output(name));
}

TEST_CASE("a path is shown as UTF-8 in one line") {
    for (const auto& [bytes, text] :
         {std::pair{"a.png", "a.png"},
          {"caf\xC3\xA9.png", "caf\xC3\xA9.png"},        // UTF-8
          {"caf\xE9.png", "caf\\xE9.png"},               // Latin-1
          {"\xF0\x9F\x90\x89", "\xF0\x9F\x90\x89"},      // four bytes
          {"\xC0\xAF", "\\xC0\\xAF"},                    // too long
          {"\xED\xA0\x80", "\\xED\\xA0\\x80"},           // half of a surrogate pair
          {"\xF4\x90\x80\x80", "\\xF4\\x90\\x80\\x80"},  // beyond U+10FFFF
          {"\xE2\x82", "\\xE2\\x82"},                    // cut off
          {"a\nb\x7F", "a\\x0Ab\\x7F"}})
        CHECK(support::text_of(bytes) == text);
}

TEST_CASE("a name in another encoding is written") {
    const Folder folder;
    const fs::path path = folder / "caf\xE9.json";
    support::write_file(path, "x");
    CHECK(read_file(path) == "x");
    CHECK(contains(write_error(folder / "caf\xE9" / "x", "x"), "caf\\xE9/x'"));
}

}  // namespace
}  // namespace cellist::test
