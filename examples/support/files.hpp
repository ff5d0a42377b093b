// SPDX-License-Identifier: MIT
#pragma once

#include <exception>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace support {

/// The reader of stdout has closed it, as `head` does: nothing reads more output, or a message.
class OutputClosed : public std::exception {
public:
    [[nodiscard]] const char* what() const noexcept override { return "stdout is closed"; }
};

/// A path for messages and JSON: UTF-8 stays as it is; other bytes and control characters become
/// "\xE9".
[[nodiscard]] std::string text_of(const std::filesystem::path& path);

/// Whether a path means stdout: "-", /dev/stdout and the like.
[[nodiscard]] bool is_standard_output(const std::filesystem::path& path);

/// Writes a file whole or not at all. A new file in the same folder replaces the old one once all
/// bytes are on the disk; until then, and after a failure, the old file stays as it was. Follows
/// symbolic links, and keeps permissions. Writes directly to a path that is not a regular file (a
/// device, a FIFO), that is a mount point, or whose folder takes no new files. "-" is stdout.
///
/// Throws InputError, with the reason, where something cannot be written, and OutputClosed where
/// the reader of stdout has closed it.
void write_file(const std::filesystem::path& path, std::string_view bytes);

/// A check before long work: throws InputError, with the reason, where write_file() is sure to
/// fail.
void check_output_path(const std::filesystem::path& path);

/// A file, and how messages name it: for the most part by the option that it was given with.
struct NamedFile {
    std::string_view name;
    std::filesystem::path path;  ///< may be empty where nothing is to be written
};

/// Throws InputError unless a file can be written at each path that is not empty, and none of them
/// is another one or an input.
void check_outputs(std::vector<NamedFile> inputs, std::span<const NamedFile> outputs);

/// Call this before anything is printed, so that errors of output have their reason. A file beyond
/// the size limit of the process then makes write() fail, without a signal. stdout is written when
/// it is flushed.
void prepare_output();

/// Throws InputError where some of the output did not reach stdout, and OutputClosed.
void flush_standard_output();

}  // namespace support
