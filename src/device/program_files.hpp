// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include <cellist/device.hpp>

namespace cellist::detail {

/// A program as a file keeps it.
struct StoredProgram {
    std::string log;     ///< of the compiler
    std::string binary;  ///< as the driver gives it
};

/// The files of a device's programs, one each: programs/ in cache_folder(), or the folder that
/// CELLIST_PROGRAM_CACHE names. There are none if that is "off" or empty, or if there is no cache
/// directory. Several processes may use a folder. No function throws for what a file system does.
class ProgramFiles {
public:
    explicit ProgramFiles(const DeviceInfo& device, std::uint64_t bytes_max = 64 << 20);

    /// The program that was stored with this key, which consists of all that the compiler read. The
    /// name of a file has the digest of the key, the device, its driver and the format. None if
    /// there is no such file, or if it is not as store() has written it.
    [[nodiscard]] std::optional<StoredProgram> load(const std::string& key) const;
    /// Writes the program's file, the whole of it or nothing. Then removes the files that were used
    /// least recently, until the folder has at most `bytes_max`.
    void store(const std::string& key, const StoredProgram& program) const;

    /// The file for a key. None if there are no files.
    [[nodiscard]] std::optional<std::filesystem::path> path_of(const std::string& key) const;

private:
    [[nodiscard]] std::string digest_of(const std::string& key) const;
    void remove_old() const;

    std::string device_;  ///< what identifies a device and its driver
    std::optional<std::filesystem::path> folder_;
    std::uint64_t bytes_max_;
};

}  // namespace cellist::detail
