// SPDX-License-Identifier: MIT
// STL files of every layout give the mesh that they were made from. Cut and damaged ones are
// refused.
#include <cctype>

#include "meshes/support/odd_file.hpp"

namespace cellist::test {
namespace {

class StlWriter {
public:
    explicit StlWriter(unsigned seed) : random_(seed) {}

    OddFile write_binary(const PlainMesh& mesh) {
        std::string header = one_of<std::string>(
            random_, {"", "made by hand", "solid ball", "solid\nfacet normal", "SOLID x"});
        header.resize(80, once_in(random_, 2) ? ' ' : '\0');
        std::string bytes = header;
        append_bytes(bytes, static_cast<std::uint32_t>(mesh.faces.size()));
        for (const auto& face : mesh.faces) {
            append_bytes(bytes, normal_of(mesh, face));
            for (const std::uint32_t v : face) append_bytes(bytes, glm::vec3(mesh.positions[v]));
            append_bytes(bytes, static_cast<std::uint16_t>(random_()));
        }
        return {"m.stl", "binary, '" + header.substr(0, 12) + "'", bytes};
    }

    OddFile write_text(const PlainMesh& mesh, std::size_t solids) {
        end_ = one_of<std::string>(random_, {"\n", "\n", "\r\n", "\r"});
        is_upper_ = once_in(random_, 4);
        std::string text = once_in(random_, 5) ? end_ : "";
        for (std::size_t s = 0; s < solids; ++s) {
            const std::string name =
                one_of<std::string>(random_, {"", " ball", " endsolid", " facet normal 0 0 1",
                                              " vertex", " solid solid", " a b c"});
            text += word("solid") + name + end_;
            const std::size_t count = mesh.faces.size();
            for (std::size_t f = s * count / solids; f < (s + 1) * count / solids; ++f)
                put_facet(text, mesh, mesh.faces[f]);
            text += word("endsolid") + (once_in(random_, 2) ? name : "") + end_;
            if (once_in(random_, 3)) text += end_;
        }
        return {"m.stl", "text, " + text.substr(0, 40), text};
    }

private:
    glm::vec3 normal_of(const PlainMesh& mesh, const std::vector<std::uint32_t>& face) {
        if (once_in(random_, 4)) return glm::vec3(0);
        std::vector<glm::dvec3> corners;
        for (const std::uint32_t v : face) corners.push_back(mesh.positions[v]);
        return glm::vec3(glm::normalize(area_vector(corners)));
    }

    std::string word(std::string text) const {
        if (is_upper_)
            for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
        return text;
    }

    void put_facet(std::string& text, const PlainMesh& mesh,
                   const std::vector<std::uint32_t>& face) {
        const glm::vec3 n = normal_of(mesh, face);
        const std::string indent = once_in(random_, 2) ? "  " : "\t";
        text += indent + word("facet normal ") + std::to_string(n.x) + " " + std::to_string(n.y) +
                " " + std::to_string(n.z) + end_ + indent + word("outer   loop") + end_;
        for (const std::uint32_t v : face) {
            const glm::dvec3& p = mesh.positions[v];
            text += word("vertex ") + number_text(random_, p.x) + " " + number_text(random_, p.y) +
                    "  " + number_text(random_, p.z) + end_;
        }
        text += indent + word("endloop") + end_ + indent + word("endfacet") + end_;
    }

    Random random_;
    std::string end_;
    bool is_upper_ = false;
};

TEST_CASE("STL files of 400 layouts give their mesh") {
    const Folder folder;
    const PlainMesh plain = icosphere();
    for (unsigned seed = 0; seed < 400; ++seed) {
        const OddFile file = seed % 2 == 0 ? StlWriter(seed).write_binary(plain)
                                           : StlWriter(seed).write_text(plain, 1 + seed % 3);
        const std::string problem = problem_of_whole(folder, file, plain);
        INFO("seed " << seed << ": " << file.layout);
        CHECK(problem == "");
    }
}

TEST_CASE("STL files that are cut are refused, or say so") {
    const Folder folder;
    const PlainMesh plain = icosphere();
    Random random(5);
    for (unsigned seed = 0; seed < 4; ++seed) {
        check_cuts(folder, StlWriter(seed).write_text(plain, 1), plain, random, 200);
        check_cuts(folder, StlWriter(seed).write_binary(plain), plain, random, 200);
    }
}

TEST_CASE("STL files with changed bytes are refused, or can be drawn") {
    const Folder folder;
    Random random(6);
    for (unsigned seed = 0; seed < 4; ++seed) {
        check_flips(folder, StlWriter(seed).write_text(icosphere(), 2), random, 60);
        check_flips(folder, StlWriter(seed).write_binary(icosphere()), random, 60);
    }
}

}  // namespace
}  // namespace cellist::test
