// SPDX-License-Identifier: MIT
#include <cellist/error.hpp>
#include <cellist/shape.hpp>

namespace cellist {

Shape::Shape(std::initializer_list<detail::Extent> extents) : dimensions_(extents.size()) {
    if (extents.size() == 0 || extents.size() > extents_.size())
        throw Error("a shape of " + std::to_string(extents.size()) +
                    " dimensions: shapes have 1 to 4");
    std::size_t dimension = 0;
    for (const auto [extent] : extents) {
        if (extent > extent_max)
            throw Error("extent " + std::to_string(extent) + " of dimension " +
                        std::to_string(dimension) + " exceeds the limit of " +
                        std::to_string(extent_max));
        extents_[dimension++] = extent;
    }
    bool empty = false;
    for (const std::uint64_t extent : extents_) empty = empty || extent == 0;
    if (empty) {
        cells_ = 0;
        return;
    }
    for (const std::uint64_t extent : extents_) {
        if (extent > cells_max / cells_)
            throw Error("a shape of " + to_string() + " cells exceeds the limit of " +
                        std::to_string(cells_max) + " cells");
        cells_ *= extent;
    }
}

std::uint64_t Shape::cell(std::initializer_list<detail::Extent> position) const {
    if (position.size() > dimensions_)
        throw Error("a position of " + std::to_string(position.size()) +
                    " coordinates in a shape of " + to_string());
    std::uint64_t index = 0;
    std::uint64_t stride = 1;
    std::size_t dimension = 0;
    for (const auto [coordinate] : position) {
        if (coordinate >= extents_[dimension])
            throw Error("coordinate " + std::to_string(coordinate) + " of dimension " +
                        std::to_string(dimension) + " is outside of the shape " + to_string());
        index += coordinate * stride;
        stride *= extents_[dimension++];
    }
    if (cells_ == 0) throw Error("the shape " + to_string() + " has no cells");
    return index;
}

std::string Shape::to_string() const {
    std::string text = std::to_string(extents_[0]);
    for (std::size_t dimension = 1; dimension < dimensions_; ++dimension)
        text += "x" + std::to_string(extents_[dimension]);
    return text;
}

}  // namespace cellist
