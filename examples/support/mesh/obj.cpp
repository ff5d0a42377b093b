// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <system_error>
#include <unordered_map>
#include <vector>

#include "beside.hpp"
#include "input_error.hpp"
#include "mtl.hpp"
#include "raw_mesh.hpp"
#include "read_file.hpp"
#include "text.hpp"
#include "text_lines.hpp"

namespace support {
namespace {

// A corner of a polygon: the indices of its position and, if the file has one, its normal, from 0.
struct Corner {
    std::uint32_t position = RawMesh::no_vertex;
    std::uint32_t normal = RawMesh::no_vertex;
};

constexpr std::uint32_t no_material = 0xFFFFFFFF;

// Statements that change nothing in a drawing of polygons: groups and names, texture coordinates,
// smoothing, levels of detail, attributes of display.
const std::set<std::string_view> ignored_statements = {
    "bevel", "c_interp", "d_interp",   "g",         "lod",    "maplib", "mg",
    "o",     "s",        "shadow_obj", "trace_obj", "usemap", "vp",     "vt"};

// Curves, surfaces and what belongs to them.
const std::set<std::string_view> free_form_statements = {
    "bmat", "bsp",  "bzp",  "cdc", "cdp",  "con", "cstype", "ctech", "curv", "curv2", "deg",
    "end",  "hole", "parm", "res", "scrv", "sp",  "stech",  "step",  "surf", "trim"};

class ObjReader {
public:
    ObjReader(const std::filesystem::path& path, const std::string& text)
        : path_(path), lines_(text) {}

    RawMesh read() {
        while (lines_.next()) {
            split(without_comment(lines_.line()), words_);
            if (!words_.empty()) statement(words_[0]);
        }
        if (lines_.is_unfinished()) fail("the file ends, but a backslash continues its last line");
        mesh_.ends_within_line = lines_.is_open();
        resolve_materials();
        resolve_corners();
        add_notes();
        return std::move(mesh_);
    }

private:
    [[noreturn]] void fail(const std::string& what) const {
        throw InputError(quoted("mesh", path_) + ", line " + std::to_string(lines_.number()) +
                         ": " + what);
    }

    void note(const std::string& what) {
        mesh_.notes.push_back("line " + std::to_string(lines_.number()) + ": " + what);
    }

    void statement(std::string_view keyword) {
        if (keyword == "v") {
            vertex();
        } else if (keyword == "vn") {
            if (words_.size() != 4) fail_values("3");
            normals_.emplace_back(number(1), number(2), number(3));
        } else if (keyword == "f" || keyword == "fo") {
            face();
        } else if (keyword == "p") {
            mesh_.drops.points_and_lines += words_.size() - 1;
        } else if (keyword == "l") {
            ++mesh_.drops.points_and_lines;
        } else if (keyword == "usemtl") {
            use_material();
        } else if (keyword == "mtllib") {
            material_library();
        } else if (keyword == "curv" || keyword == "curv2" || keyword == "surf") {
            ++free_forms_;
        } else if (keyword == "call" || keyword == "csh") {
            fail("'" + std::string(keyword) + "' runs another file, which is not supported");
        } else if (!ignored_statements.contains(keyword) &&
                   !free_form_statements.contains(keyword)) {
            fail("'" + printable(keyword) + "' is not an OBJ statement");
        }
    }

    [[noreturn]] void fail_values(const std::string& expected) const {
        fail("'" + std::string(words_[0]) + "' has " + std::to_string(words_.size() - 1) +
             " values, it needs " + expected +
             (lines_.is_open() ? "; the file ends there and is truncated" : ""));
    }

    [[nodiscard]] float number(std::size_t word) const {
        const std::optional<double> value = parse_number(words_[word]);
        if (!value) fail("'" + printable(words_[word]) + "' is not a number");
        return to_float(*value);
    }

    // x y z, then a weight, or red green blue, or red green blue opacity.
    void vertex() {
        const std::size_t values = words_.size() - 1;
        if (values != 3 && values != 4 && values != 6 && values != 7) fail_values("3, 4, 6 or 7");
        if (positions_.size() == RawMesh::most) fail("more than 4294967294 vertices");
        positions_.emplace_back(number(1), number(2), number(3));
        if (values == 4 && number(4) != 1) ++weights_;
        if (values < 6) {
            if (!colours_.empty()) colours_.emplace_back(no_colour);
            return;
        }
        colours_.resize(positions_.size(), glm::vec4(no_colour));
        for (std::size_t i = 4; i <= values; ++i) {
            const float value = number(i);
            if (!(value >= 0))
                fail("a colour is '" + printable(words_[i]) + "', it must be 0 or more");
            colours_.back()[static_cast<int>(i) - 4] = value;
            if (i < 7) greatest_colour_ = std::max(greatest_colour_, value);
        }
    }

    // An index in the file counts from 1; a negative index counts back from the last value so far.
    [[nodiscard]] std::uint32_t index(std::string_view word, std::size_t so_far) const {
        const std::optional<std::int64_t> value = parse_integer(word);
        if (!value) {
            // An integer with too many digits counts as an index out of range.
            const bool digits =
                word.size() > 18 && std::all_of(word.begin() + 1, word.end(),
                                                [](char c) { return c >= '0' && c <= '9'; });
            if (!digits) fail("'" + printable(word) + "' is not an index");
            return RawMesh::no_vertex;
        }
        const std::int64_t from_zero =
            *value > 0 ? *value - 1 : static_cast<std::int64_t>(so_far) + *value;
        if (*value == 0 || from_zero < 0 || from_zero >= RawMesh::no_vertex)
            return RawMesh::no_vertex;
        return static_cast<std::uint32_t>(from_zero);
    }

    // "7", "7/3", "7//2", "7/3/2". Some exporters leave parts out: "7/".
    [[nodiscard]] Corner corner(std::string_view word) {
        Corner corner;
        const std::size_t first = std::min(word.find('/'), word.size());
        corner.position = index(word.substr(0, first), positions_.size());
        if (first == word.size()) return corner;
        const std::size_t second = std::min(word.find('/', first + 1), word.size());
        const std::string_view texture = word.substr(first + 1, second - first - 1);
        if (!texture.empty()) (void)index(texture, 0);
        if (second >= word.size() - 1) return corner;
        const std::string_view normal = word.substr(second + 1);
        corner.normal = index(normal, normals_.size());
        if (corner.normal == RawMesh::no_vertex) ++missing_normals_;
        return corner;
    }

    void face() {
        if (words_.size() < 4) {
            if (lines_.is_open()) fail_values("3 or more");
            ++mesh_.drops.points_and_lines;
            return;
        }
        if (corners_.size() + words_.size() > RawMesh::most)
            fail("more than 4294967294 corners of polygons");
        for (std::size_t i = 1; i < words_.size(); ++i) corners_.push_back(corner(words_[i]));
        mesh_.face_ends.push_back(static_cast<std::uint32_t>(corners_.size()));
        mesh_.face_materials.push_back(material_);
    }

    // "usemtl" without a name goes back to no material.
    void use_material() {
        const std::string name(name_of(lines_.line()));
        const auto [entry, is_new] =
            material_numbers_.try_emplace(name, static_cast<std::uint32_t>(names_.size()));
        if (is_new) names_.push_back(name);
        material_ = entry->second;
    }

    void material_library() {
        const std::string_view name = name_of(lines_.line());
        if (name.empty()) {
            note("'mtllib' names no file");
            return;
        }
        // One name that may have blanks, or several names.
        const auto exists = [&](const std::string& file) {
            const auto path = path_beside(path_, file);
            std::error_code error;
            return path && std::filesystem::exists(*path, error);
        };
        if (words_.size() == 2 || exists(with_slashes(name))) {
            material_file(with_slashes(name));
            return;
        }
        const std::vector<std::string_view> files(words_.begin() + 1, words_.end());
        for (const std::string_view file : files) material_file(with_slashes(file));
    }

    [[nodiscard]] static std::string with_slashes(std::string_view name) {
        std::string out(name);
        std::replace(out.begin(), out.end(), '\\', '/');
        return out;
    }

    // A mesh can be drawn without its materials, so a missing file is not an error.
    void material_file(const std::string& name) {
        if (!material_files_.insert(name).second) return;
        const std::string shown = "material file '" + printable(name) + "'";
        const auto path = path_beside(path_, name);
        std::error_code error;
        if (!path)
            note(shown + " is not in the mesh's folder and was not read");
        else if (!std::filesystem::is_regular_file(*path, error))
            note(shown + " does not exist or is not a regular file");
        else if (read_mtl(*path, library_))
            note(shown + " ends within a line and may be cut off");
    }

    void resolve_materials() {
        if (std::all_of(mesh_.face_materials.begin(), mesh_.face_materials.end(),
                        [](std::uint32_t material) { return material == no_material; })) {
            mesh_.face_materials.clear();
            return;
        }
        std::uint64_t undefined = 0;
        std::string first;
        std::vector<bool> used(names_.size() + 1);
        for (std::uint32_t& material : mesh_.face_materials) {
            material = std::min(material, static_cast<std::uint32_t>(names_.size()));
            used[material] = true;
        }
        for (std::size_t i = 0; i < names_.size(); ++i) {
            const std::string& name = names_[i];
            auto found = library_.find(name);
            if (found == library_.end()) found = library_.find(name.substr(0, name.find(" #")));
            MeshMaterial& look = mesh_.materials.emplace_back();
            look.name = name;
            if (!used[i]) continue;
            if (found != library_.end()) {
                look = found->second.look;
                mesh_.ignored_textures += found->second.textures;
            } else if (!name.empty() && undefined++ == 0) {
                first = printable(name);
            }
        }
        mesh_.materials.emplace_back();  // of the faces before the first usemtl
        if (undefined > 0)
            mesh_.notes.push_back("materials that no material file has: " +
                                  std::to_string(undefined) + ", the first is '" + first + "'");
    }

    // A vertex of the mesh has one normal, so a position that has several normals is repeated.
    void resolve_corners() {
        mesh_.positions = std::move(positions_);
        mesh_.colours = linear_colours();
        std::unordered_map<std::uint64_t, std::uint32_t> repeated;
        std::vector<std::uint32_t> normal_of;
        if (!normals_.empty()) {
            normal_of.assign(mesh_.positions.size(), unused);
            mesh_.normals.assign(mesh_.positions.size(), glm::vec3(0));
        }
        mesh_.corners.reserve(corners_.size());
        for (const Corner& corner : corners_)
            mesh_.corners.push_back(vertex_of(corner, normal_of, repeated));
    }

    [[nodiscard]] std::uint32_t vertex_of(
        const Corner& corner, std::vector<std::uint32_t>& normal_of,
        std::unordered_map<std::uint64_t, std::uint32_t>& repeated) {
        const std::size_t vertices = normal_of.empty() ? mesh_.positions.size() : normal_of.size();
        const std::uint32_t vertex = corner.position;
        if (vertex >= vertices) return RawMesh::no_vertex;
        if (normal_of.empty()) return vertex;
        std::uint32_t normal = corner.normal;
        if (normal >= normals_.size() && normal != RawMesh::no_vertex) {
            ++missing_normals_;
            normal = RawMesh::no_vertex;
        }
        const glm::vec3 value = normal == RawMesh::no_vertex ? glm::vec3(0) : normals_[normal];
        if (normal_of[vertex] == unused) {
            normal_of[vertex] = normal;
            mesh_.normals[vertex] = value;
        }
        if (normal_of[vertex] == normal) return vertex;
        const auto [entry, is_new] =
            repeated.try_emplace(std::uint64_t{vertex} << 32 | normal,
                                 static_cast<std::uint32_t>(mesh_.positions.size()));
        if (is_new) {
            if (mesh_.positions.size() == RawMesh::most)
                fail("more than 4294967294 pairs of a vertex and a normal");
            mesh_.positions.push_back(mesh_.positions[vertex]);
            mesh_.normals.push_back(value);
            if (!mesh_.colours.empty()) mesh_.colours.push_back(mesh_.colours[vertex]);
        }
        return entry->second;
    }

    // Vertex colours are not in the specification of the format. Programs take them from images, so
    // they are sRGB, from 0 to 1 or from 0 to 255.
    [[nodiscard]] std::vector<glm::vec4> linear_colours() {
        std::vector<glm::vec4> colours = std::move(colours_);
        const auto fraction = [](float value, float greatest) {
            return std::min(static_cast<double>(value) / (greatest > 1 ? 255 : 1), 1.0);
        };
        float greatest_opacity = 0;
        for (const glm::vec4& colour : colours)
            greatest_opacity = std::max(greatest_opacity, colour.a);
        for (glm::vec4& colour : colours) {
            for (int i = 0; i < 3; ++i)
                colour[i] = linear_from_srgb(fraction(colour[i], greatest_colour_));
            colour.a = to_float(fraction(colour.a, greatest_opacity));
        }
        return colours;
    }

    void add_notes() {
        const auto add = [&](const std::string& what, std::uint64_t count) {
            if (count > 0) mesh_.notes.push_back(what + ": " + std::to_string(count));
        };
        add("free-form curves and surfaces, which are not drawn", free_forms_);
        add("vertices with a weight other than 1, which is ignored", weights_);
        add("corners that name a normal that does not exist, so that theirs is made",
            missing_normals_);
    }

    static constexpr std::uint32_t unused = 0xFFFFFFFE;
    static constexpr float no_colour = std::numeric_limits<float>::infinity();

    const std::filesystem::path& path_;
    TextLines lines_;
    std::vector<std::string_view> words_;
    RawMesh mesh_;
    std::vector<glm::vec3> positions_, normals_;
    std::vector<glm::vec4> colours_;  // of the positions so far, or empty
    float greatest_colour_ = 0;
    std::vector<Corner> corners_;
    MtlLibrary library_;
    std::set<std::string> material_files_;
    std::map<std::string, std::uint32_t> material_numbers_;
    std::vector<std::string> names_;  // of the materials that faces may use
    std::uint32_t material_ = no_material;
    std::uint64_t free_forms_ = 0, weights_ = 0, missing_normals_ = 0;
};

}  // namespace

RawMesh read_obj(const std::filesystem::path& path, const std::string& text) {
    return ObjReader(path, text).read();
}

}  // namespace support
