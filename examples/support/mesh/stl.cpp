// SPDX-License-Identifier: MIT
#include "stl.hpp"

#include <algorithm>
#include <cctype>
#include <cstring>

#include "input_error.hpp"
#include "raw_mesh.hpp"
#include "read_file.hpp"
#include "text.hpp"

namespace support {
namespace {

constexpr std::size_t header_bytes = 84, triangle_bytes = 50;

std::uint32_t little_endian(std::string_view bytes, std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = 4; i-- > 0;)
        value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
    return value;
}

bool same_word(std::string_view word, std::string_view lower) {
    return std::equal(word.begin(), word.end(), lower.begin(), lower.end(), [](char a, char b) {
        return std::tolower(static_cast<unsigned char>(a)) == b;
    });
}

// The headers of many binary files start with "solid" as well: text goes on with a facet.
bool is_text(std::string_view text) {
    if (is_binary_stl(text)) return false;
    TextCursor words(text);
    if (!same_word(words.next_word(), "solid")) return false;
    (void)words.rest_of_line();
    const std::string_view next = words.next_word();
    if (same_word(next, "facet") || same_word(next, "endsolid")) return true;
    // A binary file has a zero byte in its number of triangles.
    return text.substr(0, header_bytes).find('\0') == std::string_view::npos;
}

void add_corner(RawMesh& mesh, const glm::vec3& position, const glm::vec3& normal) {
    mesh.corners.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
    mesh.positions.push_back(position);
    mesh.normals.push_back(normal);
}

void end_face(RawMesh& mesh) {
    mesh.face_ends.push_back(static_cast<std::uint32_t>(mesh.corners.size()));
}

RawMesh read_binary(const std::filesystem::path& path, std::string_view bytes) {
    const std::string name = quoted("mesh", path);
    if (bytes.size() < header_bytes)
        throw InputError(name + " is truncated: it has " + std::to_string(bytes.size()) +
                         " bytes, a binary STL file has at least 84");
    const std::uint64_t count = little_endian(bytes, 80);
    const std::uint64_t held = (bytes.size() - header_bytes) / triangle_bytes;
    if (count > held)
        throw InputError(name + " is truncated or no STL file: it declares " +
                         std::to_string(count) + " triangles, it has " + std::to_string(held));
    RawMesh mesh;
    for (std::uint64_t i = 0; i < count; ++i) {
        const std::size_t begin = header_bytes + static_cast<std::size_t>(i) * triangle_bytes;
        glm::vec3 vectors[4];
        for (std::size_t k = 0; k < 12; ++k) {
            const std::uint32_t bits = little_endian(bytes, begin + 4 * k);
            std::memcpy(&vectors[k / 3][static_cast<int>(k % 3)], &bits, sizeof bits);
        }
        for (std::size_t k = 1; k < 4; ++k) add_corner(mesh, vectors[k], vectors[0]);
        end_face(mesh);
    }
    mesh.drops.bytes_after_end =
        bytes.size() - header_bytes - static_cast<std::size_t>(count) * triangle_bytes;
    return mesh;
}

class TextReader {
public:
    TextReader(const std::filesystem::path& path, std::string_view text)
        : path_(path), size_bytes_(text.size()), words_(text) {}

    RawMesh read() {
        while (same_word(peek(), "solid")) read_solid();
        const std::string_view rest = words_.next_word();
        if (!rest.empty())
            mesh_.drops.bytes_after_end = size_bytes_ - words_.offset() + rest.size();
        return std::move(mesh_);
    }

private:
    [[nodiscard]] std::string_view peek() const {
        TextCursor ahead = words_;
        return ahead.next_word();
    }

    [[noreturn]] void fail(std::string_view word, const std::string& wanted) const {
        if (words_.at_end())
            throw InputError(quoted("mesh", path_) + " is truncated: no " + wanted +
                             " follows facet " + std::to_string(mesh_.face_ends.size()));
        throw InputError(quoted("mesh", path_) + " is damaged: line " +
                         std::to_string(words_.line()) + " has '" + printable(word) +
                         "' instead of " + wanted);
    }

    void expect(std::string_view keyword) {
        const std::string_view word = words_.next_word();
        if (!same_word(word, keyword)) fail(word, "'" + std::string(keyword) + "'");
    }

    // A name may be any text to the line's end.
    void read_solid() {
        expect("solid");
        (void)words_.rest_of_line();
        while (same_word(peek(), "facet")) read_facet();
        expect("endsolid");
        (void)words_.rest_of_line();
    }

    void read_facet() {
        expect("facet");
        expect("normal");
        const glm::vec3 normal = read_vector();
        expect("outer");
        expect("loop");
        while (same_word(peek(), "vertex")) {
            expect("vertex");
            add_corner(mesh_, read_vector(), normal);
        }
        expect("endloop");
        expect("endfacet");
        end_face(mesh_);
    }

    glm::vec3 read_vector() {
        glm::vec3 v(0);
        for (int i = 0; i < 3; ++i) {
            const std::string_view word = words_.next_word();
            const auto value = parse_number(word);
            if (!value) fail(word, "a number");
            v[i] = to_float(*value);
        }
        return v;
    }

    const std::filesystem::path& path_;
    std::size_t size_bytes_;
    TextCursor words_;
    RawMesh mesh_;
};

}  // namespace

bool is_binary_stl(std::string_view text) {
    return text.size() > header_bytes &&
           header_bytes + std::uint64_t{triangle_bytes} * little_endian(text, 80) == text.size();
}

RawMesh read_stl(const std::filesystem::path& path, const std::string& text) {
    return is_text(text) ? TextReader(path, text).read() : read_binary(path, text);
}

}  // namespace support
