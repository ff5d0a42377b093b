// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace support {

/// The name of a picture, or of the pictures of all frames: "frame-%04d.png". "%%" is a per cent
/// sign.
class PictureName {
public:
    /// Throws InputError for any other use of a per cent sign, and for several numbers.
    explicit PictureName(const std::filesystem::path& path);

    [[nodiscard]] bool has_number() const { return has_number_; }
    /// The name for a frame, counted from 1.
    [[nodiscard]] std::filesystem::path of(std::uint32_t frame) const;
    /// The name as on the command line.
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
    std::string before_, after_;  ///< of the file name
    std::size_t digits_ = 0;      ///< at least
    bool has_number_ = false;
};

}  // namespace support
