// SPDX-License-Identifier: MIT
#include "ply_header.hpp"

#include <algorithm>

#include "input_error.hpp"
#include "read_file.hpp"
#include "text.hpp"

namespace support {
namespace {

constexpr std::string_view ply_blanks = " \t\v\f";
constexpr std::size_t most_items = 1000;  // elements, and properties of each

std::optional<PlyType> type_named(std::string_view name) {
    if (name == "char" || name == "int8") return PlyType::int8;
    if (name == "uchar" || name == "uint8") return PlyType::uint8;
    if (name == "short" || name == "int16") return PlyType::int16;
    if (name == "ushort" || name == "uint16") return PlyType::uint16;
    if (name == "int" || name == "int32") return PlyType::int32;
    if (name == "uint" || name == "uint32") return PlyType::uint32;
    if (name == "float" || name == "float32") return PlyType::float32;
    if (name == "double" || name == "float64") return PlyType::float64;
    return std::nullopt;
}

// Reads the header line by line.
class HeaderReader {
public:
    HeaderReader(const std::filesystem::path& path, std::string_view text)
        : path_(path), text_(text), lines_(text) {}

    PlyHeader read() {
        if (lines_.next_word_on_line() != "ply") fail("does not start with 'ply'");
        const std::size_t end = text_.find_first_of("\r\n");
        if (end != std::string_view::npos)
            lines_end_in_cr_ = text_[end] == '\r' && text_.substr(end, 2) != "\r\n";
        (void)lines_.rest_of_line();
        while (!lines_.at_end()) {
            const std::string_view keyword = lines_.next_word_on_line();
            if (keyword == "end_header") {
                finish();
                return std::move(header_);
            }
            read_line(keyword);
            (void)lines_.rest_of_line();
        }
        throw InputError(quoted("mesh", path_) + " is truncated: its PLY header does not end");
    }

private:
    [[noreturn]] void fail(const std::string& what) const {
        throw InputError(quoted("mesh", path_) + " has a damaged PLY header: line " +
                         std::to_string(lines_.line()) + " " + what);
    }

    PlyType read_type() {
        const std::string_view name = lines_.next_word_on_line();
        const auto type = type_named(name);
        if (!type) fail("has the unknown type '" + printable(name) + "'");
        return *type;
    }

    void read_line(std::string_view keyword) {
        if (keyword == "comment") {
            if (lines_.next_word_on_line() == "TextureFile") ++header_.texture_files;
        } else if (keyword == "format") {
            read_format();
        } else if (keyword == "element") {
            read_element();
        } else if (keyword == "property") {
            read_property();
        } else if (!keyword.empty() && keyword != "obj_info") {
            fail("has the unknown keyword '" + printable(keyword) + "'");
        }
    }

    void read_format() {
        if (has_format_) fail("is a second 'format'");
        const std::string_view name = lines_.next_word_on_line();
        const std::string_view version = lines_.next_word_on_line();
        if (name == "binary_little_endian")
            header_.format = PlyHeader::Format::little_endian;
        else if (name == "binary_big_endian")
            header_.format = PlyHeader::Format::big_endian;
        else if (name != "ascii")
            fail("has the unknown format '" + printable(name) + "'");
        if (version != "1.0") fail("has the version '" + printable(version) + "', not 1.0");
        has_format_ = true;
    }

    void read_element() {
        PlyElement element;
        element.name = lines_.next_word_on_line();
        const std::string_view word = lines_.next_word_on_line();
        const auto count = parse_integer(word);
        if (!count || *count < 0)
            fail("gives the element '" + printable(element.name) + "' the count '" +
                 printable(word) + "'");
        if (header_.find(element.name) != nullptr)
            fail("is a second element '" + printable(element.name) + "'");
        element.count = static_cast<std::uint64_t>(*count);
        header_.elements.push_back(std::move(element));
        if (header_.elements.size() > most_items) fail("has element 1001, the limit is 1000");
    }

    void read_property() {
        if (header_.elements.empty()) fail("has a property before the first element");
        PlyElement& element = header_.elements.back();
        PlyProperty property;
        TextCursor ahead = lines_;
        if (ahead.next_word_on_line() == "list") {
            lines_ = ahead;
            property.count_type = read_type();
        }
        property.type = read_type();
        property.name = lines_.next_word_on_line();
        if (property.name.empty()) fail("has a property without a name");
        if (element.find(property.name) != nullptr)
            fail("is a second property '" + printable(property.name) + "'");
        element.properties.push_back(std::move(property));
        if (element.properties.size() > most_items) fail("has property 1001, the limit is 1000");
    }

    // Binary data may start with a byte that looks like a line end. So the last line ends with the
    // same characters as the first.
    void finish() {
        if (!has_format_) fail("ends a header without 'format'");
        std::size_t at = lines_.offset();
        const auto is_at = [&](char c) { return at < text_.size() && text_[at] == c; };
        while (at < text_.size() && ply_blanks.find(text_[at]) != std::string_view::npos) ++at;
        if (is_at('\r') && lines_end_in_cr_) {
            ++at;
        } else {
            if (is_at('\r')) ++at;
            if (is_at('\n'))
                ++at;
            else if (at < text_.size())
                fail("has more than 'end_header'");
        }
        header_.data_begin = at;
        header_.data_line = lines_.line() + 1;
    }

    const std::filesystem::path& path_;
    std::string_view text_;
    TextCursor lines_;
    bool lines_end_in_cr_ = false;
    bool has_format_ = false;
    PlyHeader header_;
};

}  // namespace

std::size_t size_bytes(PlyType type) {
    switch (type) {
        case PlyType::int8:
        case PlyType::uint8:
            return 1;
        case PlyType::int16:
        case PlyType::uint16:
            return 2;
        case PlyType::int32:
        case PlyType::uint32:
        case PlyType::float32:
            return 4;
        case PlyType::float64:
            return 8;
    }
    return 8;
}

const PlyProperty* PlyElement::find(std::string_view property) const {
    const auto found = std::find_if(properties.begin(), properties.end(),
                                    [&](const PlyProperty& p) { return p.name == property; });
    return found == properties.end() ? nullptr : &*found;
}

const PlyElement* PlyHeader::find(std::string_view element) const {
    const auto found = std::find_if(elements.begin(), elements.end(),
                                    [&](const PlyElement& e) { return e.name == element; });
    return found == elements.end() ? nullptr : &*found;
}

PlyHeader read_ply_header(const std::filesystem::path& path, std::string_view text) {
    return HeaderReader(path, text).read();
}

}  // namespace support
