// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>

namespace support {

/// The mean structural similarity of two images of one channel between 0 and 1, row by row: 1 where
/// they are equal (Wang, Bovik, Sheikh, Simoncelli, IEEE Transactions on Image Processing 13,
/// 2004). The window is a Gaussian of 11 x 11 pixels with deviation 1.5; at the borders it is what
/// lies in the image of it, so images may be of any size.
[[nodiscard]] double mean_ssim(std::span<const double> a, std::span<const double> b,
                               std::size_t width, std::size_t height);

}  // namespace support
