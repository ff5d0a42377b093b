// SPDX-License-Identifier: MIT
// OFF files of every layout give the mesh that they were made from. Cut and damaged ones are
// refused.
#include "meshes/support/odd_file.hpp"

namespace cellist::test {
namespace {

class OffWriter {
public:
    explicit OffWriter(unsigned seed) : random_(seed) {}

    OddFile write(const PlainMesh& mesh) {
        const std::string line_end = one_of<std::string>(random_, {"\n", "\n", "\r\n", "\r"});
        const bool has_texture = once_in(random_, 5), has_normal = once_in(random_, 4);
        const bool has_colour = once_in(random_, 4), has_face_colour = once_in(random_, 3);
        const bool is_plain = !has_texture && !has_normal && !has_colour;
        const bool has_word = !is_plain || !once_in(random_, 5);
        const bool is_free = is_plain && !has_face_colour && once_in(random_, 3);
        const std::string end = is_free ? " " : line_end;
        std::string text;
        const auto comment = [&] {
            if (!is_free && once_in(random_, 10)) text += "# 1 2 3" + line_end;
        };
        if (once_in(random_, 10)) text += "\xEF\xBB\xBF";
        comment();
        if (has_word)
            text += std::string(has_texture ? "ST" : "") + (has_colour ? "C" : "") +
                    (has_normal ? "N" : "") + "OFF" + (once_in(random_, 3) ? " " : line_end);
        text += std::to_string(mesh.positions.size()) + " " + std::to_string(mesh.faces.size());
        if (!is_free && once_in(random_, 5))
            text += line_end;
        else
            text += " 0" + end;
        for (const glm::dvec3& p : mesh.positions) {
            comment();
            indent(text);
            text += number_text(random_, p.x) + " " + number_text(random_, p.y) + "\t" +
                    number_text(random_, p.z);
            const glm::dvec3 n = glm::normalize(p + glm::dvec3(0, 0, 1e-9));
            if (has_normal)
                text += " " + std::to_string(n.x) + " " + std::to_string(n.y) + " " +
                        std::to_string(n.z);
            if (has_colour) text += " 255 128 0 255";
            if (has_texture) text += " 0.5 0.25";
            if (!is_free && once_in(random_, 20)) text += " # a vertex";
            text += end;
        }
        for (const auto& face : mesh.faces) {
            comment();
            indent(text);
            text += std::to_string(face.size());
            for (const std::uint32_t v : face) text += " " + std::to_string(v);
            if (has_face_colour && once_in(random_, 2))
                text += one_of<std::string>(random_, {" 0.5 0.5 1", " 1 0.25 0.5 0.75", " 3"});
            text += end;
        }
        if (is_free) text += line_end;
        return {"m.off", text.substr(0, 200), text};
    }

private:
    void indent(std::string& text) {
        if (once_in(random_, 8)) text += "  ";
    }

    Random random_;
};

TEST_CASE("OFF files of 450 layouts give their mesh") {
    const Folder folder;
    for (unsigned seed = 0; seed < 450; ++seed) {
        // Normals of a sphere are those of the file; the prism's would turn its triangles round.
        const OddFile ball = OffWriter(seed).write(icosphere());
        const std::string problem = problem_of_whole(folder, ball, icosphere());
        INFO("seed " << seed << ": " << ball.layout);
        CHECK(problem == "");
        if (ball.bytes.find("NOFF") != std::string::npos) continue;
        const OddFile prism = OffWriter(seed).write(comb_prism());
        CHECK(problem_of_whole(folder, prism, comb_prism()) == "");
    }
}

TEST_CASE("OFF files that are cut are refused, or say so") {
    const Folder folder;
    const PlainMesh plain = icosphere();
    Random random(3);
    for (unsigned seed = 0; seed < 6; ++seed)
        check_cuts(folder, OffWriter(seed).write(plain), plain, random, 200);
}

TEST_CASE("OFF files with changed bytes are refused, or can be drawn") {
    const Folder folder;
    Random random(4);
    for (unsigned seed = 0; seed < 6; ++seed)
        check_flips(folder, OffWriter(seed).write(seed % 2 == 0 ? icosphere() : comb_prism()),
                    random, 60);
}

}  // namespace
}  // namespace cellist::test
