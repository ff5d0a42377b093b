// SPDX-License-Identifier: MIT
#include "device/cache_files.hpp"

#include <cerrno>
#include <cstdlib>
#include <fstream>
#include <random>
#include <system_error>

#include <cellist/error.hpp>

namespace cellist::detail {

namespace fs = std::filesystem;

namespace {

std::optional<fs::path> absolute_path_in(const char* variable) {
    const char* value = std::getenv(variable);
    if (value == nullptr || !fs::path(value).is_absolute()) return {};
    return value;
}

}  // namespace

fs::path cache_folder() {
    std::optional<fs::path> cache = absolute_path_in("XDG_CACHE_HOME");
    if (!cache)
        if (const auto home = absolute_path_in("HOME")) cache = *home / ".cache";
    if (!cache)
        throw Error("there is no cache directory: set XDG_CACHE_HOME or HOME to an absolute path");
    return *cache / "cellist";
}

std::optional<std::string> read_file(const fs::path& path, std::size_t size_max) {
    // Nothing that blocks or has no end, such as a pipe or a device.
    std::error_code error;
    if (!fs::is_regular_file(path, error)) return {};
    const std::uintmax_t size = fs::file_size(path, error);
    if (error || size > size_max) return {};
    std::ifstream file(path, std::ios::binary);
    std::string text(size, '\0');
    file.read(text.data(), static_cast<std::streamsize>(text.size()));
    if (!file) return {};
    return text;
}

fs::path write_unfinished(const fs::path& path, const std::string& text) {
    fs::path unfinished = path;
    unfinished += "." + std::to_string(std::random_device{}());
    errno = 0;
    std::ofstream file(unfinished, std::ios::binary);
    file << text;
    file.close();
    if (file.good()) return unfinished;
    const std::error_code error(errno != 0 ? errno : EIO, std::generic_category());
    std::error_code ignored;
    fs::remove(unfinished, ignored);
    throw Error("cannot write " + path.string() + ": " + error.message());
}

void replace_file(const fs::path& path, const std::string& text) {
    const fs::path unfinished = write_unfinished(path, text);
    std::error_code error;
    fs::rename(unfinished, path, error);
    if (!error) return;
    std::error_code ignored;
    fs::remove(unfinished, ignored);
    throw Error("cannot write " + path.string() + ": " + error.message());
}

}  // namespace cellist::detail
