// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <initializer_list>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <cellist/error.hpp>
#include <cellist/shape.hpp>

namespace cellist {

/// The lists of all cells in host memory, as contiguous lists. Accessors of a temporary return
/// copies, so `for (const Hit& hit : hits.download()[{640, 360}])` is safe.
template <class T>
class HostLists {
public:
    /// Takes cells() + 1 ascending offsets into `records`, the first of them 0. Checks nothing.
    HostLists(const Shape& shape, std::vector<std::uint64_t> offsets, std::vector<T> records)
        : shape_(shape), offsets_(std::move(offsets)), records_(std::move(records)) {}

    /// Returns the records of the cell at a position. Missing coordinates are 0, as on the device.
    /// Throws Error if the position is outside the shape.
    [[nodiscard]] std::span<const T> operator[](
        std::initializer_list<detail::Extent> position) const& {
        return cell(shape_.cell(position));
    }
    [[nodiscard]] std::vector<T> operator[](std::initializer_list<detail::Extent> position) && {
        return std::move(*this).cell(shape_.cell(position));
    }

    /// Returns the records of a cell by its index, 0 ... cells() - 1. Throws Error for other
    /// indices.
    [[nodiscard]] std::span<const T> cell(std::uint64_t index) const& {
        if (index >= cells())
            throw Error("cell " + std::to_string(index) + " is outside of the shape " +
                        shape_.to_string());
        return std::span<const T>(records_).subspan(offsets_[index],
                                                    offsets_[index + 1] - offsets_[index]);
    }
    [[nodiscard]] std::vector<T> cell(std::uint64_t index) && {
        const std::span<const T> records = std::as_const(*this).cell(index);
        return {records.begin(), records.end()};
    }

    [[nodiscard]] const Shape& shape() const { return shape_; }
    [[nodiscard]] std::uint64_t cells() const { return shape_.cells(); }
    /// The cells() + 1 offsets into records(), in compressed-sparse-row form. Cell c has the
    /// records offsets()[c] ... offsets()[c + 1] - 1.
    [[nodiscard]] const std::vector<std::uint64_t>& offsets() const& { return offsets_; }
    [[nodiscard]] std::vector<std::uint64_t> offsets() && { return std::move(offsets_); }
    [[nodiscard]] const std::vector<T>& records() const& { return records_; }
    [[nodiscard]] std::vector<T> records() && { return std::move(records_); }

private:
    Shape shape_;
    std::vector<std::uint64_t> offsets_;
    std::vector<T> records_;
};

}  // namespace cellist
