// SPDX-License-Identifier: MIT
#include "files.hpp"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <iostream>
#include <random>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "input_error.hpp"

namespace support {
namespace {

namespace fs = std::filesystem;

// Functions here that return an int return an errno, or 0.

std::string reason(int error) { return std::generic_category().message(error); }

InputError cannot_write(const fs::path& path, const std::string& why) {
    return InputError("cannot write '" + text_of(path) + "': " + why);
}

[[noreturn]] void throw_stdout_error(int error) {
    if (error == EPIPE) throw OutputClosed();
    throw InputError("cannot write to stdout" + (error != 0 ? ": " + reason(error) : ""));
}

// The length of the UTF-8 sequence at the beginning of a text (RFC 3629), or 0.
std::size_t utf8_length(std::string_view text) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    const unsigned first = byte(0);
    if (first < 0x80) return 1;
    const std::size_t length = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
    if (first < 0xC2 || first > 0xF4 || text.size() < length) return 0;
    unsigned code = first & (0x7FU >> length);
    for (std::size_t i = 1; i < length; ++i) {
        if ((byte(i) & 0xC0U) != 0x80) return 0;
        code = code << 6 | (byte(i) & 0x3FU);
    }
    constexpr unsigned least[] = {0, 0, 0x80, 0x800, 0x10000};
    const bool is_surrogate = code >= 0xD800 && code < 0xE000;
    return code < least[length] || code > 0x10FFFF || is_surrogate ? 0 : length;
}

// The target of a path. Does not follow links to open files (/dev/stdout): they may lead to the
// name of a file that another process writes.
fs::path target_of(fs::path path) {
    std::error_code error;
    constexpr int most_links = 40;
    for (int link = 0; link < most_links; ++link) {
        const fs::path folder =
            fs::canonical(path.has_parent_path() ? path.parent_path() : fs::path("."), error);
        if (error) return path;
        path = folder / path.filename();
        if (folder.native().starts_with("/proc/") || !fs::is_symlink(path, error)) return path;
        path = folder / fs::read_symlink(path, error);
    }
    return path;
}

// Exists, and is neither a file nor a folder.
bool is_special(const fs::path& path) {
    std::error_code error;
    const fs::file_status status = fs::status(path, error);
    return fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status);
}

int write_all(int file, std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t written = ::write(file, bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) return errno;
        bytes.remove_prefix(static_cast<std::size_t>(written));
    }
    return 0;
}

int write_and_close(int file, std::string_view bytes, bool to_disk) {
    int error = write_all(file, bytes);
    // With remote disks, or quotas that are counted late, only fsync reports that there was no
    // room.
    if (error == 0 && to_disk && ::fsync(file) != 0 && errno != EINVAL) error = errno;
    if (::close(file) != 0 && error == 0) error = errno;
    return error;
}

int write_directly(const fs::path& path, std::string_view bytes) {
    const int file = ::open(path.c_str(), O_WRONLY | O_TRUNC | O_CLOEXEC | O_NOCTTY);
    return file < 0 ? errno : write_and_close(file, bytes, false);
}

int replace(const fs::path& path, std::string_view bytes) {
    struct stat old {};
    const bool exists = ::stat(path.c_str(), &old) == 0;
    if (!exists && errno != ENOENT) return errno;
    if (exists && ::access(path.c_str(), W_OK) != 0) return errno;
    const fs::path unfinished =
        path.parent_path() / (".cellist-" + std::to_string(std::random_device{}()));
    const int file =
        ::open(unfinished.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode_t{0666});
    if (file < 0) {
        const int why = errno;
        // A folder that takes no new file may hold one that can be written. A full disk may not.
        const bool is_closed = why == EACCES || why == EPERM || why == EROFS;
        return exists && is_closed ? write_directly(path, bytes) : why;
    }
    // Where the process may not set the old permissions, the file keeps those of a new file.
    if (exists) (void)(::fchmod(file, old.st_mode & mode_t{07777}) == 0);
    int error = write_and_close(file, bytes, true);
    if (error == 0 && ::rename(unfinished.c_str(), path.c_str()) != 0) error = errno;
    if (error == 0) return 0;
    ::unlink(unfinished.c_str());
    // A file that is a mount point, as in containers, cannot be replaced.
    return error == EBUSY && exists ? write_directly(path, bytes) : error;
}

bool same_file(const fs::path& a, const fs::path& b) {
    // Paths that cannot be followed are refused where they are opened.
    std::error_code error;
    if (is_standard_output(a)) return is_standard_output(b);
    // Several outputs may go to /dev/null.
    if (fs::is_character_file(a, error)) return false;
    if (fs::equivalent(a, b, error)) return true;
    const auto full = [&](const fs::path& path) {
        return fs::weakly_canonical(fs::absolute(path, error), error);
    };
    return full(a) == full(b) && !error;
}

}  // namespace

std::string text_of(const fs::path& path) {
    std::string_view bytes = path.native();
    std::string text;
    while (!bytes.empty()) {
        const std::size_t length = utf8_length(bytes);
        const unsigned first = static_cast<unsigned char>(bytes[0]);
        if (length == 0 || first < 0x20 || first == 0x7F) {
            char code[5];
            std::snprintf(code, sizeof code, "\\x%02X", first);
            text += code;
            bytes.remove_prefix(1);
        } else {
            text += bytes.substr(0, length);
            bytes.remove_prefix(length);
        }
    }
    return text;
}

bool is_standard_output(const fs::path& path) {
    if (path.empty()) return false;
    std::error_code error;
    const fs::path descriptors = fs::canonical("/proc/self/fd", error);
    return path == "-" || (!error && target_of(path) == descriptors / "1");
}

void write_file(const fs::path& path, std::string_view bytes) {
    if (is_standard_output(path)) {
        flush_standard_output();
        if (const int error = write_all(STDOUT_FILENO, bytes)) throw_stdout_error(error);
        return;
    }
    const fs::path target = target_of(path);
    const int error = is_special(target) || target.native().starts_with("/proc/")
                          ? write_directly(target, bytes)
                          : replace(target, bytes);
    if (error != 0) throw cannot_write(path, reason(error));
}

void check_output_path(const fs::path& path) {
    if (path.empty()) throw InputError("the output path is empty");
    if (is_standard_output(path)) return;
    const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
    std::error_code error;
    if (!fs::is_directory(folder, error))
        throw cannot_write(path, "the folder '" + text_of(folder) + "' does not exist");
    if (fs::is_directory(path, error)) throw cannot_write(path, "it is a folder");
    const bool exists = fs::exists(path, error);
    if (::access(exists ? path.c_str() : folder.c_str(), W_OK) != 0)
        throw cannot_write(path, reason(errno));
}

void check_outputs(std::vector<NamedFile> inputs, std::span<const NamedFile> outputs) {
    std::vector<NamedFile> known = std::move(inputs);
    for (const NamedFile& output : outputs) {
        const auto& [name, path] = output;
        if (path.empty()) continue;
        check_output_path(path);
        for (const auto& [other, its_path] : known)
            if (same_file(path, its_path))
                throw InputError(std::string(name) + " and " + std::string(other) +
                                 " name the same file, '" + text_of(path) + "'");
        known.push_back(output);
    }
}

void prepare_output() {
    // The buffer holds more than a program prints, so that errors occur at the flush: stdio loses
    // the reason of earlier ones.
    static std::array<char, 1 << 16> buffer;
    (void)std::signal(SIGXFSZ, SIG_IGN);
    static const bool is_buffered = ::isatty(STDOUT_FILENO) == 1 ||
                                    std::setvbuf(stdout, buffer.data(), _IOFBF, buffer.size()) == 0;
    (void)is_buffered;
}

void flush_standard_output() {
    errno = 0;
    std::cout.flush();
    if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0 && std::cout.good()) return;
    const int error = errno;
    // Marks the stream as failed, so that the rest of its buffer does not fail again at exit.
    std::cout.setstate(std::ios::badbit);
    throw_stdout_error(error);
}

}  // namespace support
