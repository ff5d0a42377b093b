// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "colour_table.hpp"
#include "ply_source.hpp"
#include "raw_mesh.hpp"

namespace support {
namespace {

// A vertex of the mesh from a value of the file.
std::uint32_t index_of(double value) {
    const bool is_index = value >= 0 && value < RawMesh::no_vertex && value == std::floor(value);
    return is_index ? static_cast<std::uint32_t>(value) : RawMesh::no_vertex;
}

// The values of one element, by property. Skips properties that want() did not name.
struct Row {
    explicit Row(const PlyElement& e)
        : element(e), values(e.properties.size(), 0), wanted(e.properties.size(), false) {}

    // Index of a property that is to be read; nothing where there is no such property.
    std::optional<std::size_t> want(std::string_view name, bool is_list) {
        const PlyProperty* property = element.find(name);
        if (property == nullptr || property->count_type.has_value() != is_list) return std::nullopt;
        const auto index = static_cast<std::size_t>(property - element.properties.data());
        wanted[index] = true;
        return index;
    }

    template <std::size_t n>
    std::optional<std::array<std::size_t, n>> want_all(const std::array<const char*, n>& names) {
        std::array<std::size_t, n> found{};
        for (std::size_t i = 0; i < n; ++i) {
            const PlyProperty* property = element.find(names[i]);
            if (property == nullptr || property->count_type) return std::nullopt;
        }
        for (std::size_t i = 0; i < n; ++i) found[i] = *want(names[i], false);
        return found;
    }

    const PlyElement& element;
    std::vector<double> values;
    std::vector<bool> wanted;
    std::vector<double> list;  // of the list that is wanted; one at most
};

// The properties of an element that are its colour, and the greatest value of a channel.
class Colour {
public:
    explicit Colour(Row& row) {
        channels_ = row.want_all<3>({"red", "green", "blue"});
        if (!channels_)
            channels_ = row.want_all<3>({"diffuse_red", "diffuse_green", "diffuse_blue"});
        alpha_ = row.want("alpha", false);
        const auto range_of = [&](std::size_t property) {
            switch (row.element.properties[property].type) {
                case PlyType::float32:
                case PlyType::float64:
                    return 0.0;
                case PlyType::int16:
                case PlyType::uint16:
                    return 65535.0;
                default:
                    return 255.0;
            }
        };
        if (channels_) range_ = range_of((*channels_)[0]);
        if (alpha_) alpha_range_ = range_of(*alpha_);
    }

    [[nodiscard]] bool any() const { return channels_ || alpha_; }
    [[nodiscard]] bool has_opacity() const { return alpha_.has_value(); }

    // Integers are sRGB; floating-point values are linear.
    [[nodiscard]] glm::vec4 of(const Row& row) const {
        glm::vec4 colour(1);
        if (channels_)
            for (int i = 0; i < 3; ++i) {
                const double value = row.values[(*channels_)[static_cast<std::size_t>(i)]];
                colour[i] =
                    range_ > 0 ? linear_from_srgb(unit(value / range_)) : to_float(unit(value));
            }
        if (alpha_) {
            const double value = row.values[*alpha_];
            colour.a = to_float(unit(alpha_range_ > 0 ? value / alpha_range_ : value));
        }
        return colour;
    }

private:
    // NaN becomes 0.
    static double unit(double value) { return value > 0 ? std::min(value, 1.0) : 0.0; }

    std::optional<std::array<std::size_t, 3>> channels_;
    std::optional<std::size_t> alpha_;
    double range_ = 0, alpha_range_ = 0;
};

template <class Source>
class PlyReader {
public:
    PlyReader(const std::filesystem::path& path, const std::string& text, const PlyHeader& header)
        : path_(path), header_(header), source_(path, text, header) {}

    RawMesh read() {
        mesh_.ignored_textures = header_.texture_files;
        if (header_.find("vertex") == nullptr) fail("has no element 'vertex'");
        for (const PlyElement& element : header_.elements) {
            if (element.name == "vertex")
                read_vertices(element);
            else if (element.name == "face")
                read_faces(element);
            else if (element.name == "tristrips")
                read_strips(element);
            else
                read_others(element);
        }
        Row vertex_row(*header_.find("vertex"));
        if (Colour(vertex_row).has_opacity()) take_opacity_of_vertices(mesh_);
        mesh_.drops.bytes_after_end = source_.bytes_left();
        return std::move(mesh_);
    }

private:
    [[noreturn]] void fail(const std::string& what) const {
        throw InputError(quoted("mesh", path_) + " " + what);
    }

    // Reads all rows of an element and hands each to `take`.
    template <class Take>
    void read_rows(Row& row, const Take& take) {
        const PlyElement& element = row.element;
        if (element.properties.empty()) return;
        for (std::uint64_t i = 0; i < element.count; ++i) {
            if (!read_row(row))
                fail("is truncated: its header declares " + std::to_string(element.count) +
                     " of the element '" + printable(element.name) + "', it has " +
                     std::to_string(i));
            source_.end_row(element);
            take(row);
        }
    }

    // False at the end of the file.
    bool read_row(Row& row) {
        for (std::size_t p = 0; p < row.values.size(); ++p) {
            const PlyProperty& property = row.element.properties[p];
            if (!property.count_type) {
                if (!row.wanted[p]) {
                    if (!source_.skip(1, property.type)) return false;
                } else {
                    const auto value = source_.next(property.type);
                    if (!value) return false;
                    row.values[p] = *value;
                }
                continue;
            }
            const auto count = source_.next(*property.count_type);
            if (!count) return false;
            if (!(*count >= 0 && *count < 0x1p32) || *count != std::floor(*count))
                source_.fail("has a list of " + number_text(*count) + " values");
            const auto length = static_cast<std::uint64_t>(*count);
            if (!row.wanted[p]) {
                if (!source_.skip(length, property.type)) return false;
                continue;
            }
            row.list.clear();
            for (std::uint64_t i = 0; i < length; ++i) {
                const auto value = source_.next(property.type);
                if (!value) return false;
                row.list.push_back(*value);
            }
        }
        return true;
    }

    static std::string number_text(double value) {
        std::string text = std::to_string(value);
        return text.substr(0, text.find(".000000"));
    }

    void read_vertices(const PlyElement& element) {
        Row row(element);
        const auto place = row.want_all<3>({"x", "y", "z"});
        if (!place) fail("has no numbers 'x', 'y' and 'z' in its element 'vertex'");
        const auto normal = row.want_all<3>({"nx", "ny", "nz"});
        const Colour colour(row);
        const auto vector = [&row](const std::array<std::size_t, 3>& at) {
            return glm::vec3(to_float(row.values[at[0]]), to_float(row.values[at[1]]),
                             to_float(row.values[at[2]]));
        };
        read_rows(row, [&](const Row&) {
            mesh_.positions.push_back(vector(*place));
            if (normal) mesh_.normals.push_back(vector(*normal));
            if (colour.any()) mesh_.colours.push_back(colour.of(row));
        });
    }

    // The list of vertices of faces and strips.
    void want_indices(Row& row) {
        if (!row.want("vertex_indices", true) && !row.want("vertex_index", true) &&
            row.element.count > 0)
            fail("has no list 'vertex_indices' in its element '" + row.element.name + "'");
    }

    void read_faces(const PlyElement& element) {
        Row row(element);
        want_indices(row);
        const Colour colour(row);
        // Colours of vertices replace those of faces. Strips have no colours.
        Row vertex_row(*header_.find("vertex"));
        const bool has_colours =
            colour.any() && !Colour(vertex_row).any() && header_.find("tristrips") == nullptr;
        ColourTable table(mesh_);
        read_rows(row, [&](const Row&) {
            for (const double value : row.list) mesh_.corners.push_back(index_of(value));
            end_face();
            if (has_colours)
                mesh_.face_materials.push_back(
                    table.material_of(colour.of(row), colour.has_opacity()));
        });
    }

    // Each vertex of a strip makes a triangle with the two before, every other one turned round. -1
    // starts a new strip; a triangle with equal corners only continues it elsewhere.
    void read_strips(const PlyElement& element) {
        Row row(element);
        want_indices(row);
        read_rows(row, [&](const Row&) {
            std::size_t begin = 0;
            for (std::size_t i = 0; i < row.list.size(); ++i) {
                if (row.list[i] == -1 || row.list[i] == 0xFFFFFFFF) begin = i + 1;
                if (i < begin + 2) continue;
                std::uint32_t a = index_of(row.list[i - 2]), b = index_of(row.list[i - 1]);
                const std::uint32_t c = index_of(row.list[i]);
                if ((i - begin) % 2 == 1) std::swap(a, b);
                const auto same = [](std::uint32_t p, std::uint32_t q) {
                    return p == q && p != RawMesh::no_vertex;
                };
                if (same(a, b) || same(b, c) || same(c, a)) continue;
                mesh_.corners.insert(mesh_.corners.end(), {a, b, c});
                end_face();
            }
        });
    }

    void end_face() { mesh_.face_ends.push_back(static_cast<std::uint32_t>(mesh_.corners.size())); }

    void read_others(const PlyElement& element) {
        Row row(element);
        read_rows(row, [](const Row&) {});
        if (element.name == "edge" && !element.properties.empty())
            mesh_.drops.points_and_lines += element.count;
    }

    const std::filesystem::path& path_;
    const PlyHeader& header_;
    Source source_;
    RawMesh mesh_;
};

}  // namespace

RawMesh read_ply(const std::filesystem::path& path, const std::string& text) {
    const PlyHeader header = read_ply_header(path, text);
    if (header.format != PlyHeader::Format::ascii)
        return PlyReader<PlyBytes>(path, text, header).read();
    RawMesh mesh = PlyReader<PlyText>(path, text, header).read();
    mesh.ends_within_line = text.back() != '\n' && text.back() != '\r';
    return mesh;
}

}  // namespace support
