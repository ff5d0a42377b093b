// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "colour_table.hpp"
#include "input_error.hpp"
#include "raw_mesh.hpp"
#include "read_file.hpp"
#include "text.hpp"

namespace support {
namespace {

// Reads Geomview's object file format, in text. Each vertex and each face is on a line of its own;
// in files without colours, only blanks need separate the numbers.
class OffReader {
public:
    OffReader(const std::filesystem::path& path, const std::string& text)
        : path_(path), size_bytes_(text.size()), words_(text) {
        words_.set_comment('#');
    }

    RawMesh read() {
        read_header();
        vertex_count_ = read_count("vertices");
        face_count_ = read_count("faces");
        // The number of edges is not used, and may be missing.
        if (!words_.at_line_end()) (void)read_count("edges");
        has_row_a_line_ = first_vertex_ends_line() || words_.has_lines(vertex_count_ + face_count_);
        for (std::uint64_t i = 0; i < vertex_count_; ++i) read_vertex(i);
        for (std::uint64_t i = 0; i < face_count_; ++i) read_face(i);
        const std::string_view rest = words_.next_word();
        if (!rest.empty())
            mesh_.drops.bytes_after_end = size_bytes_ - words_.offset() + rest.size();
        use_colours();
        return std::move(mesh_);
    }

private:
    [[noreturn]] void fail(const std::string& what) const {
        throw InputError(quoted("mesh", path_) + " is damaged: line " +
                         std::to_string(words_.line()) + " " + what);
    }

    [[noreturn]] void fail_truncated(std::uint64_t declared, const char* what,
                                     std::uint64_t found) const {
        throw InputError(quoted("mesh", path_) + " is truncated: it declares " +
                         std::to_string(declared) + " " + what + ", it has " +
                         std::to_string(found));
    }

    // [ST][C][N][4][n]OFF, or nothing.
    void read_header() {
        TextCursor ahead = words_;
        std::string_view word = ahead.next_word();
        if (parse_number(word)) return;
        const std::string name(word);
        words_ = ahead;
        const auto takes = [&](std::string_view prefix) {
            const bool found = word.starts_with(prefix);
            if (found) word.remove_prefix(prefix.size());
            return found;
        };
        has_texture_ = takes("ST");
        has_colour_ = takes("C");
        has_normal_ = takes("N");
        if (word == "4OFF" || word == "nOFF" || word == "4nOFF")
            fail("has the header '" + name + "': vertices of 4 and more dimensions are not read");
        if (word != "OFF" && word != "off")
            fail("has '" + printable(name) + "' instead of the header 'OFF'");
        ahead = words_;
        if (ahead.next_word() == "BINARY") fail("says BINARY: only OFF files in text are read");
    }

    std::uint64_t read_count(const std::string& what) {
        const std::string_view word = words_.next_word();
        if (word.empty())
            throw InputError(quoted("mesh", path_) + " is truncated: it has no number of " + what);
        const auto count = parse_integer(word);
        if (!count || *count < 0)
            fail("has '" + printable(word) + "' instead of the number of " + what);
        return static_cast<std::uint64_t>(*count);
    }

    [[nodiscard]] std::size_t plain_words() const {
        return 3U + (has_normal_ ? 3U : 0U) + (has_texture_ ? 2U : 0U);
    }

    [[nodiscard]] bool first_vertex_ends_line() const {
        TextCursor ahead = words_;
        if (ahead.next_word().empty()) return true;
        std::size_t count = 1;
        while (!ahead.next_word_on_line().empty()) ++count;
        const std::size_t plain = plain_words();
        return count == plain || count == plain + 3 || count == plain + 4;
    }

    double number(std::string_view word) const {
        const auto value = parse_number(word);
        if (!value) fail("has '" + printable(word) + "' instead of a number");
        return *value;
    }

    // The colours of the file, whose range is known only when all are read: see use_colours().
    glm::vec4 read_colour(std::size_t channels) {
        glm::vec4 colour(0, 0, 0, no_alpha);
        for (std::size_t i = 0; i < channels; ++i) {
            const double value = number(words_.next_word());
            largest_channel_ = std::max(largest_channel_, value);
            colour[static_cast<int>(i)] = value > 0 ? to_float(value) : 0;
        }
        return colour;
    }

    // The number of words that are left on the line.
    [[nodiscard]] std::size_t words_left() const {
        TextCursor ahead = words_;
        std::size_t count = 0;
        while (!ahead.next_word_on_line().empty()) ++count;
        return count;
    }

    glm::vec3 read_vector(std::uint64_t vertex) {
        glm::vec3 v(0);
        for (int i = 0; i < 3; ++i) {
            const std::string_view word = words_.next_word();
            if (word.empty()) fail_truncated(vertex_count_, "vertices", vertex);
            v[i] = to_float(number(word));
        }
        return v;
    }

    void read_vertex(std::uint64_t i) {
        mesh_.positions.push_back(read_vector(i));
        if (has_normal_) mesh_.normals.push_back(read_vector(i));
        const std::size_t texture = has_texture_ ? 2 : 0;
        std::size_t channels = has_colour_ ? 4 : 0;
        if (has_row_a_line_) {
            const std::size_t left = words_left();
            channels = left - std::min(left, texture);
            if (left < texture || (channels != 0 && channels != 3 && channels != 4))
                fail(
                    "does not end with its vertex: it, or the line before, has too many or too "
                    "few values");
        }
        if (channels > 0) vertex_colours_.push_back(read_colour(channels));
        for (std::size_t k = 0; k < texture; ++k) (void)words_.next_word();
        if (vertex_colours_.size() != (channels > 0 ? mesh_.positions.size() : 0))
            fail("has a vertex with a colour where others have none");
    }

    void read_face(std::uint64_t i) {
        const std::string_view word = words_.next_word();
        if (word.empty()) fail_truncated(face_count_, "faces", i);
        const auto count = parse_integer(word);
        if (!count || *count < 0)
            fail("has '" + printable(word) + "' instead of the number of corners of a face");
        for (std::int64_t k = 0; k < *count; ++k) {
            const std::string_view corner =
                has_row_a_line_ ? words_.next_word_on_line() : words_.next_word();
            if (corner.empty() && words_.at_end()) fail_truncated(face_count_, "faces", i);
            if (corner.empty())
                fail("has only " + std::to_string(k) + " corners of a face of " +
                     std::to_string(*count));
            const auto index = parse_integer(corner);
            if (!index) fail("has the vertex '" + printable(corner) + "'");
            const bool is_vertex = *index >= 0 && *index < RawMesh::no_vertex;
            mesh_.corners.push_back(is_vertex ? static_cast<std::uint32_t>(*index)
                                              : RawMesh::no_vertex);
        }
        mesh_.face_ends.push_back(static_cast<std::uint32_t>(mesh_.corners.size()));
        if (!has_row_a_line_) return;
        // One number is an entry of Geomview's own colour map.
        const std::size_t left = words_left();
        if (left == 1) (void)words_.next_word();
        if (left == 2 || left > 4)
            fail("has a face with " + std::to_string(left) +
                 " values after its corners: a colour has 1, 3 or 4");
        face_colours_.push_back(left > 2 ? read_colour(left) : glm::vec4(no_alpha));
        has_face_colours_ = has_face_colours_ || left > 2;
    }

    // Colours are sRGB from 0 to 255 where a channel of the file is larger than 1, else linear.
    glm::vec4 linear(const glm::vec4& raw) const {
        const bool is_byte = largest_channel_ > 1;
        glm::vec4 colour(1);
        for (int i = 0; i < 4; ++i) {
            if (i == 3 && raw.a == no_alpha) break;
            const double value = static_cast<double>(raw[i]) / (is_byte ? 255 : 1);
            const double unit = value > 0 ? std::min(value, 1.0) : 0;
            colour[i] = is_byte && i < 3 ? linear_from_srgb(unit) : to_float(unit);
        }
        return colour;
    }

    void use_colours() {
        for (const glm::vec4& raw : vertex_colours_) mesh_.colours.push_back(linear(raw));
        if (!vertex_colours_.empty() && vertex_colours_[0].a != no_alpha)
            take_opacity_of_vertices(mesh_);
        if (!has_face_colours_ || !vertex_colours_.empty()) return;
        ColourTable table(mesh_);
        std::uint32_t plain = RawMesh::no_vertex;
        for (const glm::vec4& raw : face_colours_) {
            if (raw.r != no_alpha) {
                mesh_.face_materials.push_back(table.material_of(linear(raw), raw.a != no_alpha));
                continue;
            }
            if (plain == RawMesh::no_vertex) {
                plain = static_cast<std::uint32_t>(mesh_.materials.size());
                mesh_.materials.emplace_back();
            }
            mesh_.face_materials.push_back(plain);
        }
    }

    static constexpr float no_alpha = -1;

    const std::filesystem::path& path_;
    std::size_t size_bytes_;
    TextCursor words_;
    bool has_texture_ = false, has_colour_ = false, has_normal_ = false;
    bool has_row_a_line_ = true;
    std::uint64_t vertex_count_ = 0, face_count_ = 0;
    std::vector<glm::vec4> vertex_colours_, face_colours_;
    bool has_face_colours_ = false;
    double largest_channel_ = 0;
    RawMesh mesh_;
};

}  // namespace

RawMesh read_off(const std::filesystem::path& path, const std::string& text) {
    RawMesh mesh = OffReader(path, text).read();
    mesh.ends_within_line = text.back() != '\n' && text.back() != '\r';
    return mesh;
}

}  // namespace support
