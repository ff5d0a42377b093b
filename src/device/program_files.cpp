// SPDX-License-Identifier: MIT
#include "device/program_files.hpp"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstdlib>
#include <system_error>
#include <vector>

#include <cellist/error.hpp>

#include "device/cache_files.hpp"
#include "device/sha256.hpp"

namespace cellist::detail {

namespace fs = std::filesystem;

namespace {

/// Raise the number where the format changes.
constexpr std::string_view format = "cellist program 1\n";
constexpr std::string_view extension = ".program";
constexpr std::size_t digest_digits = 64;

std::optional<fs::path> folder_of_programs() {
    if (const char* const chosen = std::getenv("CELLIST_PROGRAM_CACHE")) {
        if (*chosen == '\0' || std::string_view(chosen) == "off") return {};
        std::error_code error;
        fs::path folder = fs::absolute(chosen, error);
        return error ? std::nullopt : std::optional(std::move(folder));
    }
    try {
        return cache_folder() / "programs";
    } catch (const Error&) {
        return {};
    }
}

/// The lines before the log and the binary.
std::string heading_of(const std::string& digest, const StoredProgram& program) {
    return std::string(format) + digest + "\n" + std::to_string(program.log.size()) + " " +
           std::to_string(program.binary.size()) + "\n";
}

/// Takes a number and the character after it from the front of `text`.
bool take_number(std::string_view& text, std::size_t& number, char after) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc()) return false;
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    if (!text.starts_with(after)) return false;
    text.remove_prefix(1);
    return true;
}

/// The program in the text of a file. None unless store() has written the text for this digest.
std::optional<StoredProgram> parse(std::string_view text, const std::string& digest) {
    if (text.size() < digest_digits) return {};
    const std::string_view sum = text.substr(text.size() - digest_digits);
    text.remove_suffix(digest_digits);
    if (sha256(text) != sum) return {};
    const std::string begin = std::string(format) + digest + "\n";
    if (!text.starts_with(begin)) return {};
    text.remove_prefix(begin.size());
    std::size_t log = 0;
    std::size_t binary = 0;
    if (!take_number(text, log, ' ') || !take_number(text, binary, '\n')) return {};
    if (log > text.size() || binary != text.size() - log) return {};
    return StoredProgram{std::string(text.substr(0, log)), std::string(text.substr(log))};
}

/// A file of the folder.
struct File {
    fs::path path;
    fs::file_time_type used;
    std::uint64_t bytes;
};

}  // namespace

ProgramFiles::ProgramFiles(const DeviceInfo& device, std::uint64_t bytes_max)
    : folder_(folder_of_programs()), bytes_max_(bytes_max) {
    for (const std::string& part : {device.platform, device.name, device.version, device.driver})
        device_ += part + '\0';
}

std::string ProgramFiles::digest_of(const std::string& key) const {
    return sha256(std::string(format) + device_ + key);
}

std::optional<fs::path> ProgramFiles::path_of(const std::string& key) const {
    if (!folder_) return {};
    return *folder_ / (digest_of(key) + std::string(extension));
}

std::optional<StoredProgram> ProgramFiles::load(const std::string& key) const {
    if (!folder_) return {};
    const std::string digest = digest_of(key);
    const fs::path path = *folder_ / (digest + std::string(extension));
    const std::optional<std::string> text = read_file(path, bytes_max_);
    if (!text) return {};
    auto program = parse(*text, digest);
    std::error_code ignored;
    if (program) fs::last_write_time(path, fs::file_time_type::clock::now(), ignored);
    return program;
}

void ProgramFiles::store(const std::string& key, const StoredProgram& program) const {
    const std::optional<fs::path> path = path_of(key);
    if (!path) return;
    std::string text = heading_of(digest_of(key), program) + program.log + program.binary;
    text += sha256(text);
    if (text.size() > bytes_max_) return;
    std::error_code error;
    // Programs run as they are found: nobody else may write here.
    if (fs::create_directories(*folder_, error))
        fs::permissions(*folder_, fs::perms::owner_all, error);
    try {
        replace_file(*path, text);
    } catch (const Error&) {
        return;
    }
    remove_old();
}

void ProgramFiles::remove_old() const {
    constexpr std::chrono::hours abandoned_after(1);
    std::vector<File> files;
    std::uint64_t bytes = 0;
    std::error_code error;
    for (fs::directory_iterator at(*folder_, error); !error && at != fs::directory_iterator();
         at.increment(error)) {
        const std::string name = at->path().filename().string();
        std::error_code gone;
        if (name.find(extension) == std::string::npos || !at->is_regular_file(gone)) continue;
        const File file{at->path(), at->last_write_time(gone), at->file_size(gone)};
        if (gone) continue;
        if (name.ends_with(extension)) {
            bytes += file.bytes;
            files.push_back(file);
        } else if (fs::file_time_type::clock::now() - file.used > abandoned_after) {
            fs::remove(file.path, gone);  // the process that wrote it has ended
        }
    }
    std::sort(files.begin(), files.end(),
              [](const File& a, const File& b) { return a.used < b.used; });
    for (auto file = files.begin(); bytes > bytes_max_ && file != files.end(); ++file) {
        std::error_code gone;
        fs::remove(file->path, gone);
        bytes -= file->bytes;
    }
}

}  // namespace cellist::detail
