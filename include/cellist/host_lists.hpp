#pragma once

#include <cstdint>
#include <initializer_list>
#include <span>
#include <vector>

#include <cellist/shape.hpp>

namespace cellist {

/// The lists of all cells in host memory, one behind the other.
template <class T>
class HostLists {
public:
    HostLists(const Shape& shape, std::vector<std::uint64_t> offsets, std::vector<T> records)
        : shape_(shape), offsets_(std::move(offsets)), records_(std::move(records)) {}

    /// The records of the cell at a position. Throws Error if it is outside of the shape.
    [[nodiscard]] std::span<const T> operator[](
        std::initializer_list<std::uint64_t> position) const {
        return cell(shape_.cell(position));
    }
    /// The records of the cell with an index in 0 ... cells() - 1.
    [[nodiscard]] std::span<const T> cell(std::uint64_t index) const {
        const std::uint64_t begin = offsets_.at(index);
        return std::span<const T>(records_).subspan(begin, offsets_.at(index + 1) - begin);
    }

    [[nodiscard]] const Shape& shape() const { return shape_; }
    [[nodiscard]] std::uint64_t cells() const { return shape_.cells(); }
    /// cells() + 1 offsets into records(): the lists in compressed-row form.
    [[nodiscard]] const std::vector<std::uint64_t>& offsets() const { return offsets_; }
    [[nodiscard]] const std::vector<T>& records() const { return records_; }

private:
    Shape shape_;
    std::vector<std::uint64_t> offsets_;
    std::vector<T> records_;
};

}  // namespace cellist
