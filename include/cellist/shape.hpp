#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <string>

namespace cellist {

/// The extents of the cells: 1 to 4 dimensions, x fastest. An extent may be 0: then there is no
/// cell, and every insert is rejected.
class Shape {
public:
    /// Largest extent of one dimension.
    static constexpr std::uint64_t extent_max = 0x7FFF'FFFF;
    /// Largest number of cells.
    static constexpr std::uint64_t cells_max = 0xFFFF'FFFE;

    /// Throws Error unless there are 1 to 4 extents, each at most `extent_max`, with a product of
    /// at most `cells_max`.
    Shape(std::initializer_list<std::uint64_t> extents);

    [[nodiscard]] std::size_t dimensions() const { return dimensions_; }
    /// Cells along a dimension; 1 for dimensions that the shape does not have.
    [[nodiscard]] std::uint64_t extent(std::size_t dimension) const {
        return dimension < dimensions_ ? extents_[dimension] : 1;
    }
    [[nodiscard]] std::uint64_t cells() const { return cells_; }

    /// The index of the cell at a position; missing coordinates are 0. Throws Error if there are
    /// more coordinates than dimensions or if one is outside.
    [[nodiscard]] std::uint64_t cell(std::initializer_list<std::uint64_t> position) const;

    /// "1280x720"
    [[nodiscard]] std::string to_string() const;

    friend bool operator==(const Shape&, const Shape&) = default;

private:
    std::array<std::uint64_t, 4> extents_{1, 1, 1, 1};
    std::size_t dimensions_ = 0;
    std::uint64_t cells_ = 1;
};

}  // namespace cellist
