// SPDX-License-Identifier: MIT
#include "read_file.hpp"

#include <algorithm>
#include <cerrno>
#include <system_error>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "input_error.hpp"

namespace support {
namespace {

struct Descriptor {
    int number;
    explicit Descriptor(int n) : number(n) {}
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    ~Descriptor() {
        if (number >= 0) close(number);
    }
};

std::string kind_of(mode_t mode) {
    if (S_ISDIR(mode)) return "a folder";
    if (S_ISFIFO(mode)) return "a FIFO, not a regular file";
    if (S_ISSOCK(mode)) return "a socket, not a regular file";
    return "a device, not a regular file";
}

}  // namespace

std::string quoted(const std::string& kind, const std::filesystem::path& path) {
    std::string name = path.string();
    std::replace_if(
        name.begin(), name.end(),
        [](char c) { return static_cast<unsigned char>(c) < ' ' || c == '\x7F'; }, '?');
    return kind + " '" + name + "'";
}

std::string read_file(const std::string& kind, const std::filesystem::path& path,
                      std::uint64_t limit_bytes) {
    const std::string name = quoted(kind, path);
    const auto fail = [&](const std::string& what) { throw InputError(name + " " + what); };
    const auto reason = [] { return std::generic_category().message(errno); };
    const auto check_size = [&](std::uint64_t bytes) {
        if (bytes > limit_bytes)
            fail("has more than " + std::to_string(limit_bytes) + " bytes, the limit");
    };
    // Without O_NONBLOCK, opening a FIFO for reading waits for a writer.
    const Descriptor file(open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY));
    if (file.number < 0) {
        if (errno == ENOENT || errno == ENOTDIR) fail("does not exist");
        if (errno == ENXIO) fail("is a socket or a device, not a regular file");
        fail("cannot be read: " + reason());
    }
    struct stat status {};
    if (fstat(file.number, &status) != 0) fail("cannot be read: " + reason());
    if (S_ISDIR(status.st_mode)) fail("is a folder");
    if (!S_ISREG(status.st_mode)) fail("is " + kind_of(status.st_mode));
    const auto size = static_cast<std::uint64_t>(std::max<off_t>(status.st_size, 0));
    check_size(size);

    std::string bytes(static_cast<std::size_t>(size), '\0');
    std::size_t end = 0;
    for (;;) {
        // The size may be wrong: the file may grow, and files of /proc say 0.
        if (end == bytes.size()) bytes.resize(end + 4096);
        const ssize_t got = read(file.number, bytes.data() + end, bytes.size() - end);
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) fail("cannot be read: " + reason());
        if (got == 0) break;
        end += static_cast<std::size_t>(got);
        check_size(end);
    }
    bytes.resize(end);
    if (bytes.empty()) fail("is empty (0 bytes)");
    return bytes;
}

}  // namespace support
