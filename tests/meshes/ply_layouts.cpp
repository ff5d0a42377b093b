// SPDX-License-Identifier: MIT
// PLY files of every layout give the mesh that they were made from. Cut and damaged ones are
// refused.
#include <bit>
#include <cstring>

#include "meshes/support/odd_file.hpp"

namespace cellist::test {
namespace {

// One row of an element: properties with their values. A list has the type of its count, too.
struct Property {
    std::string name, type, count_type;
    std::vector<double> values;
};
using Row = std::vector<Property>;

struct Element {
    std::string name;
    std::vector<Row> rows;
    Row layout;  // of its properties, without values
};

class PlyWriter {
public:
    explicit PlyWriter(unsigned seed) : random_(seed) {}

    OddFile write(const PlainMesh& mesh, const std::string& format) {
        format_ = format;
        line_end_ = one_of<std::string>(random_, {"\n", "\n", "\r\n", "\r"});
        is_free_ = format == "ascii" && once_in(random_, 4);
        is_indented_ = once_in(random_, 3);
        std::vector<Element> elements{vertices(mesh)};
        elements.push_back(mesh.has_triangles_only() && once_in(random_, 3) ? strips(mesh)
                                                                            : faces(mesh));
        for (unsigned i = below(random_, 3); i > 0; --i) elements.push_back(other(i));
        shuffle(random_, elements);
        std::string text = (once_in(random_, 10) ? "\xEF\xBB\xBFply" : "ply") + line_end_;
        comment(text);
        text += "format " + format + " 1.0" + line_end_;
        for (const Element& element : elements) {
            comment(text);
            text +=
                "element " + element.name + " " + std::to_string(element.rows.size()) + line_end_;
            for (const Property& property : element.layout) {
                comment(text);
                text += "property " +
                        (property.count_type.empty() ? "" : "list " + property.count_type + " ") +
                        property.type + " " + property.name + line_end_;
            }
        }
        comment(text);
        text += "end_header" + line_end_;
        for (const Element& element : elements)
            for (const Row& row : element.rows) put_row(text, row);
        if (is_free_) text += line_end_;
        return {"m.ply",
                format + (is_free_ ? ", free" : "") + " (" +
                    text.substr(0, text.find("end_header")) + ")",
                text};
    }

private:
    // A comment may be between any two lines, with any text.
    void comment(std::string& text) {
        if (once_in(random_, 3))
            text += one_of<std::string>(random_, {"comment made by hand", "comment end_header",
                                                  "obj_info element face 7", "comment",
                                                  "comment property float x"}) +
                    line_end_;
    }

    const std::string& integer_type() {
        static const std::vector<std::string> types{"char",  "uchar",  "short", "ushort",
                                                    "int",   "uint",   "int8",  "uint8",
                                                    "int16", "uint16", "int32", "uint32"};
        return one_of(random_, types);
    }
    const std::string& real_type() {
        static const std::vector<std::string> types{"float", "double", "float32", "float64"};
        return one_of(random_, types);
    }

    // Properties that the reader skips.
    void add_others(Row& layout, const std::string& prefix) {
        for (unsigned i = below(random_, 3); i > 0; --i) {
            Property property{prefix + std::to_string(i),
                              once_in(random_, 2) ? integer_type() : real_type(),
                              "",
                              {}};
            if (once_in(random_, 2)) property.count_type = integer_type();
            layout.push_back(property);
        }
    }

    // Values for what add_others() made.
    void fill_others(Row& row) {
        for (Property& property : row) {
            if (!property.values.empty() || property.name.find("other") != 0) continue;
            const std::size_t count = property.count_type.empty() ? 1 : random_() % 5;
            for (std::size_t i = 0; i < count; ++i)
                property.values.push_back(static_cast<double>(random_() % 100));
        }
    }

    Element vertices(const PlainMesh& mesh) {
        Element element{"vertex", {}, {}};
        const std::string type = real_type();
        for (const char* name : {"x", "y", "z"}) element.layout.push_back({name, type, "", {}});
        add_others(element.layout, "other_");
        shuffle(random_, element.layout);
        for (const glm::dvec3& p : mesh.positions) {
            Row row = element.layout;
            for (Property& property : row) {
                if (property.name == "x") property.values = {p.x};
                if (property.name == "y") property.values = {p.y};
                if (property.name == "z") property.values = {p.z};
            }
            fill_others(row);
            element.rows.push_back(row);
        }
        return element;
    }

    Row index_layout(const std::string& type) {
        Row layout{{one_of<std::string>(random_, {"vertex_indices", "vertex_index"}),
                    type,
                    integer_type(),
                    {}}};
        add_others(layout, "other_");
        shuffle(random_, layout);
        return layout;
    }

    static void set_indices(Row& row, const std::vector<double>& indices) {
        for (Property& property : row)
            if (property.name.find("vertex_ind") == 0) property.values = indices;
    }

    Element faces(const PlainMesh& mesh) {
        Element element{
            "face", {}, index_layout(once_in(random_, 6) ? real_type() : integer_type())};
        for (const auto& face : mesh.faces) {
            Row row = element.layout;
            set_indices(row, std::vector<double>(face.begin(), face.end()));
            fill_others(row);
            element.rows.push_back(row);
        }
        return element;
    }

    // Each triangle is a strip of its own: after -1, or in a list of its own.
    Element strips(const PlainMesh& mesh) {
        Element element{"tristrips", {}, index_layout("int")};
        for (Property& property : element.layout)
            if (property.name.find("vertex_ind") == 0) property.count_type = "int";
        std::vector<double> indices;
        for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
            indices.insert(indices.end(), mesh.faces[f].begin(), mesh.faces[f].end());
            if (f + 1 < mesh.faces.size() && !once_in(random_, 8)) {
                indices.push_back(-1);
                continue;
            }
            Row row = element.layout;
            set_indices(row, indices);
            fill_others(row);
            element.rows.push_back(row);
            indices.clear();
        }
        return element;
    }

    Element other(unsigned number) {
        Element element{
            "camera" + std::to_string(number), {}, {{"other_first", real_type(), "", {}}}};
        add_others(element.layout, "other_");
        for (unsigned i = below(random_, 4); i > 0; --i) {
            Row row = element.layout;
            fill_others(row);
            element.rows.push_back(row);
        }
        return element;
    }

    void put_row(std::string& text, const Row& row) {
        if (format_ != "ascii") {
            for (const Property& property : row) {
                if (!property.count_type.empty())
                    put(text, property.count_type, static_cast<double>(property.values.size()));
                for (const double value : property.values) put(text, property.type, value);
            }
            return;
        }
        std::string line;
        const auto add = [&](const std::string& word) {
            line += (line.empty() ? std::string()
                                  : one_of<std::string>(random_, {" ", " ", "\t", "  "})) +
                    word;
        };
        for (const Property& property : row) {
            if (!property.count_type.empty()) add(std::to_string(property.values.size()));
            for (const double value : property.values)
                add(property.type[0] == 'f' || property.type[0] == 'd'
                        ? number_text(random_, value)
                        : std::to_string(static_cast<int>(value)));
        }
        if (is_indented_) line = "  " + line + " ";
        text += line + (is_free_ ? " " : line_end_);
        if (!is_free_ && once_in(random_, 40)) text += line_end_;
    }

    template <class T>
    void put_as(std::string& text, double value) {
        std::string bytes;
        append_bytes(bytes, static_cast<T>(value));
        const bool is_big = format_ == "binary_big_endian";
        if (is_big != (std::endian::native == std::endian::big))
            std::reverse(bytes.begin(), bytes.end());
        text += bytes;
    }

    void put(std::string& text, const std::string& type, double value) {
        if (type == "char" || type == "int8") put_as<std::int8_t>(text, value);
        if (type == "uchar" || type == "uint8") put_as<std::uint8_t>(text, value);
        if (type == "short" || type == "int16") put_as<std::int16_t>(text, value);
        if (type == "ushort" || type == "uint16") put_as<std::uint16_t>(text, value);
        if (type == "int" || type == "int32") put_as<std::int32_t>(text, value);
        if (type == "uint" || type == "uint32") put_as<std::uint32_t>(text, value);
        if (type == "float" || type == "float32") put_as<float>(text, value);
        if (type == "double" || type == "float64") put_as<double>(text, value);
    }

    Random random_;
    std::string format_, line_end_;
    bool is_free_ = false, is_indented_ = false;
};

const std::vector<std::string> formats{"ascii", "binary_little_endian", "binary_big_endian"};

TEST_CASE("PLY files of 900 layouts give their mesh") {
    const Folder folder;
    for (unsigned seed = 0; seed < 900; ++seed) {
        const PlainMesh plain = seed % 4 == 3 ? comb_prism() : icosphere();
        const OddFile file = PlyWriter(seed).write(plain, formats[seed % 3]);
        const std::string problem = problem_of_whole(folder, file, plain);
        INFO("seed " << seed << ": " << file.layout);
        CHECK(problem == "");
    }
}

TEST_CASE("PLY files that are cut are refused, or say so") {
    const Folder folder;
    const PlainMesh plain = icosphere();
    Random random(1);
    for (unsigned seed = 0; seed < 6; ++seed)
        check_cuts(folder, PlyWriter(seed).write(plain, formats[seed % 3]), plain, random, 200);
}

TEST_CASE("PLY files with changed bytes are refused, or can be drawn") {
    const Folder folder;
    Random random(2);
    for (unsigned seed = 0; seed < 9; ++seed)
        check_flips(
            folder,
            PlyWriter(seed).write(seed % 2 == 0 ? icosphere() : comb_prism(), formats[seed % 3]),
            random, 60);
}

}  // namespace
}  // namespace cellist::test
