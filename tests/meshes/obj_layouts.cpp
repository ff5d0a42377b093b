// SPDX-License-Identifier: MIT
// OBJ files of every layout give the mesh that they were made from. Cut and damaged ones are
// refused.
#include "meshes/support/odd_file.hpp"

namespace cellist::test {
namespace {

class ObjWriter {
public:
    explicit ObjWriter(unsigned seed) : random_(seed) {}

    OddFile write(const PlainMesh& mesh) {
        line_end_ = one_of<std::string>(random_, {"\n", "\n", "\r\n", "\r"});
        is_indented_ = once_in(random_, 3);
        has_continuations_ = once_in(random_, 3);
        has_trailing_comments_ = once_in(random_, 3);
        values_ = one_of<int>(random_, {3, 3, 4, 6, 7});
        has_normals_ = once_in(random_, 2);
        has_textures_ = once_in(random_, 3);
        const bool faces_first = once_in(random_, 5);
        text_ = once_in(random_, 4) ? "\xEF\xBB\xBF" : "";
        if (once_in(random_, 2)) put({"mtllib", "missing.mtl"});
        if (once_in(random_, 5)) put_comment();
        if (has_textures_) put({"vt", "0.5", ".25", "0"});
        if (faces_first) put_faces(mesh, 0);
        for (const glm::dvec3& p : mesh.positions) {
            noise();
            put_vertex(p);
        }
        const bool has_unused = once_in(random_, 3);
        if (has_unused) put_vertex({1000, 0, 0});
        if (!faces_first) put_faces(mesh, mesh.positions.size() + (has_unused ? 1 : 0));
        if (once_in(random_, 4)) text_.resize(text_.size() - line_end_.size());
        return {"m.obj", text_.substr(0, 200), text_};
    }

private:
    void put_comment() {
        text_ += one_of<std::string>(random_, {"# v 1 2 3", "#", "# a folder\\", "#f 1 2 3"}) +
                 line_end_;
    }

    // Statements that draw nothing.
    void noise() {
        if (!once_in(random_, 12)) return;
        switch (random_() % 6) {
            case 0:
                text_ += line_end_;
                break;
            case 1:
                put_comment();
                break;
            case 2:
                put({"g", "a", "b"});
                break;
            case 3:
                put({"s", "off"});
                break;
            case 4:
                put({"o", "an object"});
                break;
            default:
                text_ += " \t " + line_end_;
        }
    }

    void put(const std::vector<std::string>& words) {
        std::string line = is_indented_ && once_in(random_, 2)
                               ? one_of<std::string>(random_, {" ", "\t", "   "})
                               : "";
        for (std::size_t i = 0; i < words.size(); ++i) {
            if (i > 0) line += one_of<std::string>(random_, {" ", " ", "  ", "\t"});
            line += words[i];
            if (has_continuations_ && i > 0 && i + 1 < words.size() && once_in(random_, 6))
                line += " \\" + line_end_;
        }
        if (words[0].size() <= 2 && has_trailing_comments_ && once_in(random_, 4))
            line += one_of<std::string>(random_, {" # 1 2 3", "# v", "  #"});
        else if (once_in(random_, 10))
            line += " ";
        text_ += line + line_end_;
    }

    void put_vertex(const glm::dvec3& p) {
        std::vector<std::string> words{"v"};
        for (const double value : {p.x, p.y, p.z}) words.push_back(number_text(random_, value));
        if (values_ == 4) words.push_back("1.0");
        for (int i = 3; values_ > 4 && i < values_; ++i) words.push_back("0.5");
        put(words);
    }

    // An index from 1 on, or back from the last of those so far.
    std::string index_text(std::size_t index, std::size_t so_far) {
        if (so_far > index && once_in(random_, 2)) return "-" + std::to_string(so_far - index);
        return std::to_string(index + 1);
    }

    void put_faces(const PlainMesh& mesh, std::size_t vertices) {
        std::size_t normals = 0;
        for (const auto& face : mesh.faces) {
            noise();
            if (once_in(random_, 10)) put({"usemtl", one_of<std::string>(random_, {"a", "b c"})});
            if (once_in(random_, 10)) put({"l", "1", "2"});
            const bool has_normal =
                has_normals_ && (!mesh.has_triangles_only() || !once_in(random_, 5));
            if (has_normal) {
                std::vector<glm::dvec3> corners;
                for (const std::uint32_t v : face) corners.push_back(mesh.positions[v]);
                const glm::dvec3 n = area_vector(corners);
                put({"vn", std::to_string(n.x), std::to_string(n.y), std::to_string(n.z)});
                ++normals;
            }
            std::vector<std::string> words{once_in(random_, 20) ? "fo" : "f"};
            const std::string texture = has_textures_ && !once_in(random_, 3) ? "1" : "";
            for (const std::uint32_t v : face) {
                std::string word = index_text(v, vertices);
                if (!texture.empty() || has_normal || once_in(random_, 20)) word += "/" + texture;
                if (has_normal) word += "/" + index_text(normals - 1, normals);
                words.push_back(word);
            }
            put(words);
        }
    }

    Random random_;
    std::string text_, line_end_;
    bool is_indented_ = false, has_continuations_ = false, has_trailing_comments_ = false;
    bool has_normals_ = false, has_textures_ = false;
    int values_ = 3;
};

TEST_CASE("OBJ files of 500 layouts give their mesh") {
    const Folder folder;
    for (unsigned seed = 0; seed < 500; ++seed) {
        const PlainMesh plain = seed % 4 == 3 ? comb_prism() : icosphere();
        const OddFile file = ObjWriter(seed).write(plain);
        const std::string problem = problem_of_whole(folder, file, plain);
        INFO("seed " << seed << ": " << file.layout);
        CHECK(problem == "");
    }
}

// An OBJ file does not declare its length, so a cut file that ends with a whole line loads: it
// gives the first triangles.
std::string problem_of_cut_obj(const Folder& folder, const std::string& bytes,
                               const PlainMesh& plain) {
    try {
        const support::Mesh mesh = support::load_mesh(folder.write("cut.obj", bytes));
        if (mesh.ends_within_line || mesh.drops.triangles() > 0) return "";
        if (bytes.back() != '\n' && bytes.back() != '\r') return "does not say that it is cut";
        PlainMesh first = plain;
        if (mesh.triangles.size() > first.faces.size()) return "has too many triangles";
        first.faces.resize(mesh.triangles.size());
        return difference(mesh, first);
    } catch (const support::InputError& error) {
        require_one_line(error.what(), "cut.obj");
        return "";
    }
}

TEST_CASE("OBJ files that are cut are refused, or say so, or give what is there") {
    const Folder folder;
    const PlainMesh plain = icosphere();
    Random random(5);
    for (unsigned seed = 0; seed < 6; ++seed) {
        const OddFile file = ObjWriter(seed).write(plain);
        std::vector<std::size_t> sizes;
        for (std::size_t i = 0; i < file.bytes.size(); ++i)
            if (file.bytes[i] == '\n' || file.bytes[i] == '\r')
                sizes.insert(sizes.end(), {i, i + 1});
        for (int i = 0; i < 200; ++i) sizes.push_back(1 + random() % (file.bytes.size() - 1));
        for (const std::size_t size : sizes) {
            const std::string problem =
                size == 0 ? "" : problem_of_cut_obj(folder, file.bytes.substr(0, size), plain);
            INFO("seed " << seed << ", cut after " << size << " of " << file.bytes.size());
            CHECK(problem == "");
        }
    }
}

TEST_CASE("OBJ files with changed bytes are refused, or can be drawn") {
    const Folder folder;
    Random random(6);
    for (unsigned seed = 0; seed < 6; ++seed)
        check_flips(folder, ObjWriter(seed).write(seed % 2 == 0 ? icosphere() : comb_prism()),
                    random, 60);
}

}  // namespace
}  // namespace cellist::test
