// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "frame/frame.hpp"
#include "page/page.hpp"
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

    /// The first is the reference.
    [[nodiscard]] const support::PagePictures& all() const { return pictures_; }
    /// The indices of the image and of the difference.
    [[nodiscard]] const std::pair<std::size_t, std::size_t>& of(const Setting& setting) const {
        return indices_.at(text(setting));
    }

private:
    [[nodiscard]] std::size_t keep(std::span<const std::uint8_t> bytes);

    const Frame& frame_;
    std::vector<cl_float4> reference_;
    support::PagePictures pictures_;
    std::map<std::string, std::pair<std::size_t, std::size_t>> indices_;
};

/// A page that needs no other file: metrics, plot and pictures of a sweep.
[[nodiscard]] std::string to_html(const Sweep& sweep, const Pictures& pictures);

}  // namespace oit
