// SPDX-License-Identifier: MIT
#include "gltf_file.hpp"

#include <algorithm>
#include <cstring>
#include <optional>
#include <system_error>

#include "beside.hpp"
#include "input_error.hpp"
#include "read_file.hpp"
#include "text.hpp"

namespace support {
namespace {

constexpr std::uint64_t most_bytes_of_buffer = std::uint64_t{1} << 32;
constexpr std::size_t limit_depth = 256;
constexpr std::size_t limit_values = std::size_t{1} << 24;

std::uint32_t word_at(std::string_view text, std::size_t at) {
    std::uint32_t word = 0;
    for (std::size_t i = 4; i-- > 0;) word = word << 8 | static_cast<unsigned char>(text[at + i]);
    return word;
}

// The nesting depth of arrays and objects, which bounds the stack of a parser, and an upper bound
// of the number of values, which bounds its memory.
struct JsonExtent {
    std::size_t depth = 0, values = 1;
};

JsonExtent extent_of(std::string_view json) {
    JsonExtent extent;
    std::size_t depth = 0;
    bool in_string = false;
    for (std::size_t i = 0; i < json.size(); ++i) {
        const char c = json[i];
        if (in_string) {
            if (c == '\\') ++i;
            if (c == '"') in_string = false;
        } else if (c == '"') {
            in_string = true;
        } else if (c == '[' || c == '{') {
            extent.depth = std::max(extent.depth, ++depth);
            ++extent.values;
        } else if (c == ']' || c == '}') {
            if (depth > 0) --depth;
        } else if (c == ',') {
            ++extent.values;
        }
    }
    return extent;
}

int hex_digit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
}

std::string percent_decoded(std::string_view text) {
    std::string out;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] == '%' && i + 2 < text.size() && hex_digit(text[i + 1]) >= 0 &&
            hex_digit(text[i + 2]) >= 0) {
            out += static_cast<char>(hex_digit(text[i + 1]) * 16 + hex_digit(text[i + 2]));
            i += 2;
        } else {
            out += text[i];
        }
    }
    return out;
}

std::optional<std::string> base64_decoded(std::string_view text) {
    while (text.ends_with('=')) text.remove_suffix(1);
    std::string out;
    out.reserve(text.size() / 4 * 3 + 3);
    std::uint32_t bits = 0;
    int count = 0;
    for (const char c : text) {
        std::uint32_t value = 0;
        if (c >= 'A' && c <= 'Z')
            value = static_cast<std::uint32_t>(c - 'A');
        else if (c >= 'a' && c <= 'z')
            value = static_cast<std::uint32_t>(c - 'a' + 26);
        else if (c >= '0' && c <= '9')
            value = static_cast<std::uint32_t>(c - '0' + 52);
        else if (c == '+' || c == '/')
            value = c == '+' ? 62 : 63;
        else
            return std::nullopt;
        bits = bits << 6 | value;
        count += 6;
        if (count >= 8) {
            count -= 8;
            out += static_cast<char>(bits >> count & 0xFF);
        }
    }
    return out;
}

// Whether a URI starts with a scheme such as "http:". A drive letter is not a scheme.
bool has_scheme(std::string_view uri) {
    const std::size_t colon = uri.find(':');
    return colon != std::string_view::npos && colon > 1 && uri.find_first_of("/?#") > colon;
}

}  // namespace

GltfFile::GltfFile(const std::filesystem::path& path, std::string_view text) : path_(path) {
    size_bytes_ = text.size();
    std::string_view json_text = text;
    if (text.starts_with("glTF")) split_glb(text, json_text);
    parse(json_text, static_cast<std::size_t>(json_text.data() - text.data()));

    const GltfValue asset = root().at("asset");
    for (const char* key : {"minVersion", "version"}) {
        const std::optional<GltfValue> version = asset.find(key);
        if (!version && key == std::string_view("minVersion")) continue;
        const std::string& number = asset.at(key).text();
        const bool is_newer = key == std::string_view("minVersion") && number != "2.0";
        if (!number.starts_with("2.") || is_newer)
            version->fail("is '" + printable(number) + "', this program reads version 2.0");
    }
}

void GltfFile::fail(const std::string& what) const {
    throw InputError(quoted("mesh", path_) + what);
}

void GltfFile::split_glb(std::string_view text, std::string_view& json_text) {
    constexpr std::size_t header_bytes = 12, chunk_header_bytes = 8;
    constexpr std::uint32_t json_chunk = 0x4E4F534A, binary_chunk = 0x004E4942;
    if (text.size() < header_bytes + chunk_header_bytes)
        fail(" is truncated: it has " + std::to_string(text.size()) +
             " bytes, a GLB file has at least 20");
    if (word_at(text, 4) != 2)
        fail(", byte 4: is GLB version " + std::to_string(word_at(text, 4)) +
             ", this program reads version 2");
    const std::size_t length = word_at(text, 8);
    if (length > text.size())
        fail(" is truncated: its header declares " + std::to_string(length) + " bytes, it has " +
             std::to_string(text.size()));
    bytes_after_end_ = text.size() - length;
    text = text.substr(0, length);

    bool has_json = false;
    for (std::size_t at = header_bytes; at < text.size();) {
        const std::string place = ", byte " + std::to_string(at) + ": ";
        if (text.size() - at < chunk_header_bytes) fail(place + "a chunk is cut off");
        const std::size_t size = word_at(text, at);
        const std::uint32_t type = word_at(text, at + 4);
        at += chunk_header_bytes;
        if (size > text.size() - at)
            fail(place + "a chunk has " + std::to_string(size) + " bytes, the file has " +
                 std::to_string(text.size() - at) + " more");
        const std::string_view chunk = text.substr(at, size);
        at += size;
        if (!has_json) {
            if (type != json_chunk) fail(place + "the first chunk is not JSON");
            json_text = chunk;
            has_json = true;
        } else if (type == binary_chunk && !has_binary_chunk_) {
            binary_chunk_ = chunk;
            has_binary_chunk_ = true;
        }
    }
    if (!has_json) fail(" has no chunk of JSON");
}

void GltfFile::parse(std::string_view json_text, std::size_t offset) {
    const JsonExtent extent = extent_of(json_text);
    if (extent.depth > limit_depth)
        fail(": its JSON is nested " + std::to_string(extent.depth) +
             " levels deep, the limit is " + std::to_string(limit_depth));
    if (extent.values > limit_values)
        fail(": its JSON has " + std::to_string(extent.values) + " values, the limit is " +
             std::to_string(limit_values));
    try {
        json_ = nlohmann::json::parse(json_text);
    } catch (const nlohmann::json::parse_error& error) {
        fail(", byte " + std::to_string(offset + error.byte) + ": its JSON is damaged or cut off");
    } catch (const nlohmann::json::exception&) {
        fail(": its JSON has a number beyond the range of double");
    }
}

std::size_t GltfFile::count(const std::string& array) const {
    const std::optional<GltfValue> values = root().find(array);
    return values ? values->size() : 0;
}

std::size_t GltfFile::element_index(const std::string& array, const GltfValue& index) const {
    const std::uint64_t number = index.integer();
    const std::size_t elements = count(array);
    if (number >= elements)
        index.fail("is " + std::to_string(number) + ", the file has " + std::to_string(elements) +
                   " " + array);
    return number;
}

GltfValue GltfFile::element(const std::string& array, const GltfValue& index) const {
    return root().at(array)[element_index(array, index)];
}

std::string_view GltfFile::buffer(const GltfValue& index) {
    const std::size_t number = element_index("buffers", index);
    const auto known = buffers_.find(number);
    if (known != buffers_.end()) return known->second;
    const GltfValue buffer = root().at("buffers")[number];
    const std::string_view bytes = load_buffer(buffer, number);
    const GltfValue length = buffer.at("byteLength");
    if (bytes.size() < length.integer(most_bytes_of_buffer))
        length.fail("is " + std::to_string(length.integer(most_bytes_of_buffer)) +
                    ", but the buffer has " + std::to_string(bytes.size()) +
                    " bytes: it is cut off");
    return buffers_[number] = bytes;
}

std::string_view GltfFile::load_buffer(const GltfValue& buffer, std::size_t number) {
    const std::optional<GltfValue> uri = buffer.find("uri");
    if (!uri) {
        if (number != 0 || !has_binary_chunk_)
            buffer.fail("has no 'uri', and the file has no binary chunk for it");
        return binary_chunk_;
    }
    const std::string_view text = uri->text();
    std::string& bytes = loaded_[number];
    if (text.starts_with("data:")) {
        const std::size_t comma = text.find(',');
        if (comma == std::string_view::npos) uri->fail("is a data URI without data");
        std::string data = percent_decoded(text.substr(comma + 1));
        if (text.substr(0, comma).ends_with(";base64")) {
            std::optional<std::string> decoded = base64_decoded(data);
            if (!decoded) uri->fail("has characters that base64 does not allow");
            data = *std::move(decoded);
        }
        bytes = std::move(data);
        return bytes;
    }
    if (has_scheme(text)) uri->fail("is not in the mesh's folder, and only files there are read");
    const auto file = path_beside(path_, percent_decoded(text));
    if (!file) uri->fail("is not in the mesh's folder, and only files there are read");
    try {
        bytes = read_file("buffer", *file, most_bytes_of_buffer);
    } catch (const InputError& error) {
        uri->fail(error.what());
    }
    size_bytes_ += bytes.size();
    return bytes;
}

bool GltfFile::uses_extension(std::string_view name) const {
    for (const char* key : {"extensionsUsed", "extensionsRequired"})
        if (const std::optional<GltfValue> names = root().find(key))
            for (std::size_t i = 0; i < names->size(); ++i)
                if ((*names)[i].text() == name) return true;
    return false;
}

}  // namespace support
