#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "input_error.hpp"
#include "mesh.hpp"

// Assimp fills a truncated PLY file with zeros, and does not come back from a truncated header.
// This walks the declared elements first.

namespace support {
namespace {

struct Property {
    std::size_t count_bytes = 0;  // size of a list's count; 0 for scalars
    std::size_t value_bytes = 0;
};

struct Element {
    std::string name;
    std::uint64_t count = 0;
    std::vector<Property> properties;
};

std::size_t type_bytes(std::string_view type) {
    if (type == "char" || type == "uchar" || type == "int8" || type == "uint8") return 1;
    if (type == "short" || type == "ushort" || type == "int16" || type == "uint16") return 2;
    if (type == "int" || type == "uint" || type == "int32" || type == "uint32" || type == "float" ||
        type == "float32")
        return 4;
    if (type == "double" || type == "float64") return 8;
    return 0;
}

struct Header {
    enum class Format { ascii, little, big } format = Format::ascii;
    std::vector<Element> elements;
    std::size_t end = 0;
};

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& what) {
    throw InputError("mesh '" + path.string() + "' " + what);
}

Header read_header(const std::filesystem::path& path, std::string_view text) {
    Header header;
    std::size_t begin = 0;
    while (begin < text.size()) {
        const std::size_t newline = text.find('\n', begin);
        if (newline == std::string_view::npos) break;
        std::istringstream line{std::string(text.substr(begin, newline - begin))};
        begin = newline + 1;
        std::string word;
        line >> word;
        if (word == "end_header") {
            header.end = begin;
            return header;
        }
        if (word == "format") {
            line >> word;
            header.format = word == "binary_little_endian" ? Header::Format::little
                            : word == "binary_big_endian"  ? Header::Format::big
                                                           : Header::Format::ascii;
        } else if (word == "element") {
            Element element;
            if (!(line >> element.name >> element.count)) fail(path, "has a damaged PLY header");
            header.elements.push_back(element);
        } else if (word == "property" && !header.elements.empty()) {
            Property property;
            line >> word;
            if (word == "list") {
                line >> word;
                property.count_bytes = type_bytes(word);
                if (property.count_bytes == 0) fail(path, "has a damaged PLY header");
                line >> word;
            }
            property.value_bytes = type_bytes(word);
            if (property.value_bytes == 0) fail(path, "has a damaged PLY header");
            header.elements.back().properties.push_back(property);
        }
    }
    fail(path, "is truncated: its PLY header has no end");
}

// Reads the next value, as text or as binary, and returns it where it is needed: for counts.
class Body {
public:
    Body(std::string_view bytes, Header::Format format) : bytes_(bytes), format_(format) {}

    bool skip(std::uint64_t values, std::size_t value_bytes) {
        if (format_ != Header::Format::ascii) {
            if (values > (bytes_.size() - at_) / value_bytes) return false;
            at_ += values * value_bytes;
            return true;
        }
        for (std::uint64_t i = 0; i < values; ++i)
            if (token().empty()) return false;
        return true;
    }

    bool count(std::size_t value_bytes, std::uint64_t& value) {
        value = 0;
        if (format_ == Header::Format::ascii) {
            const std::string_view text = token();
            for (const char c : text) {
                if (c < '0' || c > '9' || value > 0xFFFFFFFF) return false;
                value = value * 10 + static_cast<std::uint64_t>(c - '0');
            }
            return !text.empty();
        }
        if (bytes_.size() - at_ < value_bytes) return false;
        for (std::size_t i = 0; i < value_bytes; ++i) {
            const std::size_t byte = format_ == Header::Format::big ? i : value_bytes - 1 - i;
            value = value << 8 | static_cast<unsigned char>(bytes_[at_ + byte]);
        }
        at_ += value_bytes;
        return true;
    }

private:
    std::string_view token() {
        const auto is_space = [](char c) { return c == ' ' || (c >= '\t' && c <= '\r'); };
        while (at_ < bytes_.size() && is_space(bytes_[at_])) ++at_;
        const std::size_t begin = at_;
        while (at_ < bytes_.size() && !is_space(bytes_[at_])) ++at_;
        return bytes_.substr(begin, at_ - begin);
    }

    std::string_view bytes_;
    Header::Format format_;
    std::size_t at_ = 0;
};

bool has_whole(Body& body, const Element& element) {
    for (const Property& property : element.properties) {
        std::uint64_t values = 1;
        if (property.count_bytes != 0 && !body.count(property.count_bytes, values)) return false;
        if (!body.skip(values, property.value_bytes)) return false;
    }
    return true;
}

}  // namespace

void check_ply_is_complete(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    char magic[4] = {};
    file.read(magic, 4);
    if (file.gcount() != 4 ||
        (std::memcmp(magic, "ply\n", 4) != 0 && std::memcmp(magic, "ply\r", 4) != 0))
        return;
    file.seekg(0);
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    const Header header = read_header(path, text);
    Body body(std::string_view(text).substr(header.end), header.format);
    for (const Element& element : header.elements) {
        if (element.properties.empty()) continue;
        for (std::uint64_t i = 0; i < element.count; ++i)
            if (!has_whole(body, element))
                fail(path, "is truncated or damaged: its header declares " +
                               std::to_string(element.count) + " of '" + element.name +
                               "', it has " + std::to_string(i));
    }
}

}  // namespace support
