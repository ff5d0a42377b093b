// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

namespace support {

/// The pictures of a page, as PNG files in data URIs. Equal ones are kept once.
class PagePictures {
public:
    /// Takes sRGB of 3 bytes a pixel. Returns the index of the picture.
    std::size_t keep(std::span<const std::uint8_t> bytes, int width, int height);

    [[nodiscard]] const std::vector<std::string>& uris() const { return uris_; }

private:
    std::vector<std::string> uris_;
    std::map<std::string, std::size_t> known_;  ///< by the bytes of the file
};

/// What a page has of its program.
struct PageParts {
    std::string title;
    std::string_view main;  ///< HTML, with {{stage}} where two pictures are compared
    /// Before table.js. Defines `drawn`, an array of objects with `ms`, `psnr_db`, `picture` and
    /// `difference` (indices of pictures); nameOf() and summaryOf() of such an object;
    /// `referenceName`; and `firstShown`, an index of `drawn`.
    std::string_view text_script;
    std::string main_script;  ///< after table.js
};

/// A page that needs no other file. Picture 0 is the reference. `metrics` go into the script as an
/// object of this name, with the pictures.
[[nodiscard]] std::string html_page(const PageParts& parts, nlohmann::ordered_json metrics,
                                    const PagePictures& pictures);

/// A text as HTML shows it.
[[nodiscard]] std::string escaped(std::string_view text);

/// Base64 (RFC 4648).
[[nodiscard]] std::string base64(std::string_view bytes);

}  // namespace support
