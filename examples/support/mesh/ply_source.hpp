// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "input_error.hpp"
#include "ply_header.hpp"
#include "read_file.hpp"
#include "text.hpp"

namespace support {

/// The values of a text PLY file. The usual layout has one element on each line; in others, any
/// blanks separate the values.
class PlyText {
public:
    PlyText(const std::filesystem::path& path, const std::string& text, const PlyHeader& header)
        : path_(path),
          words_(std::string_view(text).substr(header.data_begin)),
          size_bytes_(text.size()),
          data_(header.data_begin),
          data_line_(header.data_line) {
        std::uint64_t rows = 0;
        for (const PlyElement& element : header.elements)
            if (!element.properties.empty()) rows += element.count;
        has_row_a_line_ = words_.has_lines(rows);
    }

    /// The next value; nothing at the end of the file.
    std::optional<double> next(PlyType) {
        const std::string_view word = words_.next_word();
        if (word.empty()) return std::nullopt;
        const auto value = parse_number(word);
        if (!value) fail("has '" + printable(word) + "' instead of a number");
        return value;
    }

    bool skip(std::uint64_t values, PlyType) {
        for (std::uint64_t i = 0; i < values; ++i)
            if (words_.next_word().empty()) return false;
        return true;
    }

    /// Call this after each element. If the first one ends its line, all others must end theirs.
    void end_row(const PlyElement& element) {
        if (is_first_row_ && words_.at_line_end()) has_row_a_line_ = true;
        is_first_row_ = false;
        if (has_row_a_line_ && !words_.at_line_end())
            fail("does not end with its '" + printable(element.name) +
                 "': it, or the line before, has too many or too few values");
    }

    /// The number of bytes from the first word after all elements.
    std::uint64_t bytes_left() {
        const std::string_view word = words_.next_word();
        return word.empty() ? 0 : size_bytes_ - data_ - words_.offset() + word.size();
    }

    [[noreturn]] void fail(const std::string& what) const {
        throw InputError(quoted("mesh", path_) + " is damaged: line " +
                         std::to_string(data_line_ + words_.line() - 1) + " " + what);
    }

private:
    const std::filesystem::path& path_;
    TextCursor words_;
    std::size_t size_bytes_, data_;
    std::uint64_t data_line_;
    bool has_row_a_line_ = false, is_first_row_ = true;
};

/// The values of a binary PLY file.
class PlyBytes {
public:
    PlyBytes(const std::filesystem::path& path, const std::string& text, const PlyHeader& header)
        : path_(path),
          bytes_(text),
          at_(header.data_begin),
          swaps_((header.format == PlyHeader::Format::big_endian) !=
                 (std::endian::native == std::endian::big)) {}

    std::optional<double> next(PlyType type) {
        if (bytes_.size() - at_ < size_bytes(type)) return std::nullopt;
        switch (type) {
            case PlyType::int8:
                return take<std::int8_t>();
            case PlyType::uint8:
                return take<std::uint8_t>();
            case PlyType::int16:
                return take<std::int16_t>();
            case PlyType::uint16:
                return take<std::uint16_t>();
            case PlyType::int32:
                return take<std::int32_t>();
            case PlyType::uint32:
                return take<std::uint32_t>();
            case PlyType::float32:
                return take<float>();
            case PlyType::float64:
                return take<double>();
        }
        return std::nullopt;
    }

    bool skip(std::uint64_t values, PlyType type) {
        if (values > (bytes_.size() - at_) / size_bytes(type)) return false;
        at_ += static_cast<std::size_t>(values) * size_bytes(type);
        return true;
    }

    void end_row(const PlyElement&) {}

    std::uint64_t bytes_left() const {
        const bool padding = bytes_.find_first_not_of(std::string_view("\0 \t\r\n", 5), at_) ==
                             std::string_view::npos;
        return padding ? 0 : bytes_.size() - at_;
    }

    [[noreturn]] void fail(const std::string& what) const {
        throw InputError(quoted("mesh", path_) + " is damaged: it " + what + " before byte " +
                         std::to_string(at_));
    }

private:
    template <class T>
    double take() {
        unsigned char raw[sizeof(T)];
        for (std::size_t i = 0; i < sizeof(T); ++i)
            raw[swaps_ ? sizeof(T) - 1 - i : i] = static_cast<unsigned char>(bytes_[at_ + i]);
        T value;
        std::memcpy(&value, raw, sizeof(T));
        at_ += sizeof(T);
        return static_cast<double>(value);
    }

    const std::filesystem::path& path_;
    std::string_view bytes_;
    std::size_t at_;
    bool swaps_;
};

}  // namespace support
