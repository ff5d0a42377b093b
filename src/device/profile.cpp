// SPDX-License-Identifier: MIT
#include "device/profile.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <system_error>

#include <cellist/error.hpp>

#include "device/cache_files.hpp"

namespace cellist::detail {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t size_max = 4096;                 ///< bytes of a file that may be a profile
constexpr std::uint64_t cost_max = 1'000'000'000'000;  ///< picoseconds a record: a second

/// The lines of a profile that say whose it is.
std::string heading(const DeviceInfo& device) {
    const auto one_line = [](std::string text) {
        for (char& c : text)
            if (c == '\n' || c == '\r') c = ' ';
        return text;
    };
    return "cellist profile 1\ndevice " + one_line(device.name) + "\nplatform " +
           one_line(device.platform) + "\ndriver " + one_line(device.driver) + "\n";
}

std::uint64_t picoseconds(double seconds) {
    return static_cast<std::uint64_t>(
        std::clamp(std::round(seconds * 1e12), 1.0, static_cast<double>(cost_max)));
}

/// Takes known text from the front of `text`.
bool take(std::string_view& text, std::string_view known) {
    if (!text.starts_with(known)) return false;
    text.remove_prefix(known.size());
    return true;
}

/// Takes a number from 1 to `most` from the front of `text`.
bool take(std::string_view& text, std::uint64_t& number, std::uint64_t most) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || number == 0 || number > most) return false;
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    return true;
}

}  // namespace

const char* name_of(Pattern pattern) {
    return pattern == Pattern::coherent ? "coherent" : "random";
}

std::string profile_text(const DeviceInfo& device, const Profile& profile) {
    std::string text = heading(device) + "records " + std::to_string(profile.records()) + "\n";
    for (const Storage storage : choices)
        for (const Pattern pattern : patterns) {
            const Cost& cost = profile.cost(storage, pattern);
            text += std::string(name_of(storage)) + " " + name_of(pattern) + " build_ps " +
                    std::to_string(picoseconds(cost.build_seconds)) + " read_ps " +
                    std::to_string(picoseconds(cost.read_seconds)) + "\n";
        }
    return text + "end\n";
}

std::optional<Profile> parse_profile(const DeviceInfo& device, std::string_view text) {
    std::uint64_t records = 0;
    if (!take(text, heading(device)) || !take(text, "records ") ||
        !take(text, records, ~std::uint64_t{0}) || !take(text, "\n"))
        return {};
    Profile profile(records);
    for (const Storage storage : choices)
        for (const Pattern pattern : patterns) {
            std::uint64_t build = 0;
            std::uint64_t read = 0;
            if (!take(text, name_of(storage)) || !take(text, " ") ||
                !take(text, name_of(pattern)) || !take(text, " build_ps ") ||
                !take(text, build, cost_max) || !take(text, " read_ps ") ||
                !take(text, read, cost_max) || !take(text, "\n"))
                return {};
            profile.set_cost(
                storage, pattern,
                {1e-12 * static_cast<double>(build), 1e-12 * static_cast<double>(read)});
        }
    if (text != "end\n") return {};
    return profile;
}

fs::path profile_path(const DeviceInfo& device) {
    std::string name = device.name + "-" + device.platform + "-" + device.driver;
    for (char& c : name) {
        const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                           (c >= '0' && c <= '9') || c == '.' || c == '-';
        if (!plain) c = '_';
    }
    return cache_folder() / (name.substr(0, 200) + ".profile");
}

std::optional<Profile> load_profile(const DeviceInfo& device) {
    try {
        const auto text = read_file(profile_path(device), size_max);
        return text ? parse_profile(device, *text) : std::nullopt;
    } catch (const Error&) {
        return {};
    }
}

fs::path prepare_profile(const DeviceInfo& device) {
    fs::path path = profile_path(device);
    std::error_code error;
    fs::create_directories(path.parent_path(), error);
    if (error)
        throw Error("cannot make the directory " + path.parent_path().string() + ": " +
                    error.message());
    const fs::file_status status = fs::status(path, error);
    if (fs::exists(status) && !fs::is_regular_file(status))
        throw Error("cannot write " + path.string() + ": it is not a file");
    fs::remove(write_unfinished(path, std::string(size_max, ' ')), error);
    return path;
}

void save_profile(const DeviceInfo& device, const Profile& profile) {
    replace_file(prepare_profile(device), profile_text(device, profile));
}

}  // namespace cellist::detail
