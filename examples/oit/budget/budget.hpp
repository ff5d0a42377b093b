// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace oit {

/// How far a picture is from the truth: errors of sRGB-encoded channels from 0 to 1.
struct PictureError {
    double largest = 0;      ///< of any channel of any pixel
    double mean_square = 0;  ///< over all channels of all pixels

    /// Infinite where there is no error.
    [[nodiscard]] double psnr_db() const;
};

/// A bound of the error of a picture against real arithmetic.
struct PictureErrors {
    PictureError resolved;  ///< without the larger error that undecided pixels may have
    PictureError all;
    /// Pixels whose order of layers float depths do not resolve, where the other order could be
    /// over the limit that the picture was compared for.
    std::uint64_t undecided_pixels = 0;
};

/// How far a picture may be from the truth.
///
///     cellist-oit dragon.ply --budget 40dB      PSNR of at least 40 dB
///     cellist-oit dragon.ply --budget 1/255     no channel off by more than 1/255; also 0.004
///
/// The truth is the frame in real numbers: all layers, each with its own depth. Where two layers
/// lie so close that float depths do not resolve which is in front, the pixel is undecided, and
/// neither order is wrong (see Survey), unless the budget is strict.
///
/// 1. Survey draws the frame once with all layers in float. For each pixel it finds how far that
///    can be from the truth, and what packing, fewer layers or an early end would change.
/// 2. BudgetSearch goes through settings_for(frame). Settings whose surveyed error is too large
///    are not drawn. The others are drawn against each other, cheapest first: first the slower
///    ones are removed, then those over budget. If times do not resolve which of the rest is
///    fastest, the plainest of them is chosen. The error of a setting is the bound that its method
///    has for it (MethodInfo::bound). Where that is too wide or missing, it is the difference from
///    the survey's picture plus that picture's own bound. So what is promised holds against the
///    truth, and no reference on the CPU is needed.
/// 3. BudgetController draws frames with the chosen setting, and surveys again when time or camera
///    change. A frame over budget is drawn again with another setting.
struct Budget {
    enum class Kind { largest, psnr };
    Kind kind = Kind::largest;
    double limit = 0;  ///< largest error, or dB
    /// Undecided pixels that are over the limit with either order of layers do not meet the budget.
    bool strict = false;

    [[nodiscard]] bool met_by(const PictureError& error) const;
    [[nodiscard]] bool met_by(const PictureErrors& errors) const { return met_by(counted(errors)); }
    /// The one of the errors that counts for this budget.
    [[nodiscard]] const PictureError& counted(const PictureErrors& errors) const {
        return strict ? errors.all : errors.resolved;
    }
    /// The error of a channel above which an undecided pixel is counted.
    [[nodiscard]] double pixel_limit() const { return kind == Kind::largest ? limit : 0; }
    /// The error in the budget's terms: "0.71/255" or "41.3 dB".
    [[nodiscard]] std::string text_of(const PictureError& error) const;
    /// True where `a` is nearer to the truth.
    [[nodiscard]] bool better(const PictureError& a, const PictureError& b) const;
    /// As on the command line.
    [[nodiscard]] std::string text() const;
};

/// Reads "40dB" (also "40 db"), "1/255" or "0.004". Throws InputError at anything else, and at
/// limits that every picture meets or none can.
[[nodiscard]] Budget parse_budget(std::string_view text);

}  // namespace oit
