#pragma once

#include <exception>
#include <filesystem>
#include <string>
#include <string_view>

namespace support {

/// The reader of stdout has gone, as `head` does: nobody waits for more, or for a message.
class OutputClosed : public std::exception {
public:
    [[nodiscard]] const char* what() const noexcept override { return "stdout is closed"; }
};

/// A path as messages and JSON show it: UTF-8 as it is; other bytes and control characters as "\xE9".
[[nodiscard]] std::string text_of(const std::filesystem::path& path);

/// Whether a path means stdout: "-", /dev/stdout and the like.
[[nodiscard]] bool is_standard_output(const std::filesystem::path& path);

/// Writes a file whole or not at all: into a new file beside it, which replaces it once all is on the
/// disk. Until then, and where that fails, an old file stays as it was. Symbolic links are followed,
/// and permissions kept. What is no regular file (a device, a FIFO) is written directly; so is a file
/// in a folder that takes no new files. "-" is stdout.
///
/// Throws InputError, with the reason, where something cannot be written, and OutputClosed.
void write_file(const std::filesystem::path& path, std::string_view bytes);

/// Throws InputError, with the reason, where write_file() is known to fail: for a check before long work.
void check_output_path(const std::filesystem::path& path);

/// Call this before anything is printed, so that errors of output have their reason: a file beyond the
/// limit of the process is an error of write() and no signal, and stdout is written when it is flushed.
void prepare_output();

/// Throws InputError where not all that was printed has reached stdout, and OutputClosed.
void flush_standard_output();

}  // namespace support
