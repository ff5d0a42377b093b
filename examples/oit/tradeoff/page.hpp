#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "frame/frame.hpp"
#include "reference/reference.hpp"
#include "tradeoff/sweep.hpp"

namespace oit {

/// The pictures of a page, and how they differ from the reference. Equal ones are kept once.
class Pictures {
public:
    /// Refers to the reference and the frame, which must outlive it.
    Pictures(const Reference& reference, const Frame& frame);

    /// `image` is linear, eye by eye.
    void add(const Setting& setting, const std::vector<cl_float4>& image);

    /// PNG files as data URIs; the first is the reference.
    [[nodiscard]] std::span<const std::string> uris() const { return uris_; }
    /// The indices of the image and of the difference.
    [[nodiscard]] const std::pair<std::size_t, std::size_t>& of(const Setting& setting) const {
        return pictures_.at(text(setting));
    }

private:
    [[nodiscard]] std::size_t keep(std::span<const std::uint8_t> bytes);

    const Frame& frame_;
    std::vector<cl_float4> reference_;
    std::vector<std::string> uris_;
    std::map<std::string, std::size_t> known_;
    std::map<std::string, std::pair<std::size_t, std::size_t>> pictures_;
};

/// A page that needs no other file: metrics, plot and pictures of a sweep.
[[nodiscard]] std::string to_html(const Sweep& sweep, const Pictures& pictures);

/// A text as HTML shows it.
[[nodiscard]] std::string escaped(std::string_view text);

/// Base64 (RFC 4648).
[[nodiscard]] std::string base64(std::string_view bytes);

}  // namespace oit
