// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <string>

#include <cellist/detail/api.hpp>
#include <cellist/detail/extent.hpp>

namespace cellist {

/// The extents of the cells: 1 to 4 dimensions, x fastest. If an extent is 0, there are no cells,
/// and every insert is rejected.
class CELLIST_API Shape {
public:
    /// The largest extent of one dimension.
    static constexpr std::uint64_t extent_max = 0x7FFF'FFFF;
    /// The largest number of cells.
    static constexpr std::uint64_t cells_max = 0xFFFF'FFFE;

    /// Takes integers of any type, e.g. `Shape{width, height}`. Throws Error unless there are 1 to
    /// 4 extents, each from 0 to `extent_max`, with a product of at most `cells_max`.
    Shape(std::initializer_list<detail::Extent> extents);

    [[nodiscard]] std::size_t dimensions() const { return dimensions_; }
    /// Returns the extent of a dimension, or 1 if the shape does not have that dimension.
    [[nodiscard]] std::uint64_t extent(std::size_t dimension) const {
        return dimension < dimensions_ ? extents_[dimension] : 1;
    }
    [[nodiscard]] std::uint64_t cells() const { return cells_; }

    /// Returns the index of the cell at a position. Missing coordinates are 0. Throws Error if the
    /// position has more coordinates than the shape has dimensions, or if it is outside the shape.
    [[nodiscard]] std::uint64_t cell(std::initializer_list<detail::Extent> position) const;

    /// Returns the extents as text, e.g. "1280x720".
    [[nodiscard]] std::string to_string() const;

    friend bool operator==(const Shape&, const Shape&) = default;

private:
    std::array<std::uint64_t, 4> extents_{1, 1, 1, 1};
    std::size_t dimensions_ = 0;
    std::uint64_t cells_ = 1;
};

}  // namespace cellist
