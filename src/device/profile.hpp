// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include <cellist/device.hpp>
#include <cellist/options.hpp>

namespace cellist::detail {

/// What a build takes, and one read of all its lists.
struct Cost {
    double build_seconds = 0;
    double read_seconds = 0;
};

/// The storages that a choice is made among, in the order of their values.
inline constexpr std::array choices{Storage::linked, Storage::counted, Storage::fixed};

/// How `cellist tune` inserts: neighbouring work-items into neighbouring cells, or into cells that
/// have nothing to do with one another.
enum class Pattern { coherent, random };
inline constexpr std::array patterns{Pattern::coherent, Pattern::random};

[[nodiscard]] const char* name_of(Pattern pattern);

/// What a device was measured to do: the cost of a record in lists of `records` together.
class Profile {
public:
    explicit Profile(std::uint64_t records) : records_(records) {}

    [[nodiscard]] std::uint64_t records() const { return records_; }
    [[nodiscard]] const Cost& cost(Storage storage, Pattern pattern) const {
        return costs_[static_cast<std::size_t>(storage)][static_cast<std::size_t>(pattern)];
    }
    void set_cost(Storage storage, Pattern pattern, const Cost& cost) {
        costs_[static_cast<std::size_t>(storage)][static_cast<std::size_t>(pattern)] = cost;
    }

private:
    std::uint64_t records_;
    std::array<std::array<Cost, patterns.size()>, choices.size()> costs_{};
};

/// A profile as the text of a file, times in whole picoseconds.
[[nodiscard]] std::string profile_text(const DeviceInfo& device, const Profile& profile);
/// The profile in a text. None unless profile_text() could have written it for this device.
[[nodiscard]] std::optional<Profile> parse_profile(const DeviceInfo& device, std::string_view text);

/// The file of a device and its driver in the user's cache directory: cellist/ in $XDG_CACHE_HOME,
/// or in $HOME/.cache. Throws Error if neither is set to an absolute path.
[[nodiscard]] std::filesystem::path profile_path(const DeviceInfo& device);
/// The same. Makes the directory, and throws Error where no file can be written there.
std::filesystem::path prepare_profile(const DeviceInfo& device);
/// The profile in the device's file. None if there is no such file, or nothing of use in it.
[[nodiscard]] std::optional<Profile> load_profile(const DeviceInfo& device);
/// Writes the device's file, the whole of it or nothing. Throws Error.
void save_profile(const DeviceInfo& device, const Profile& profile);

}  // namespace cellist::detail
