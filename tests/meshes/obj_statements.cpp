// SPDX-License-Identifier: MIT
// OBJ statements: what is drawn, what is dropped and counted, and what is refused with its line.
#include <cmath>

#include "meshes/support/loaded.hpp"

namespace cellist::test {
namespace {

const std::string square_vertices = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

support::Mesh load_obj(const std::string& text) { return load_text("m.obj", text); }

TEST_CASE("faces with an index that does not exist are dropped and counted") {
    for (const char* face : {"f 0 1 2", "f 1 2 9", "f -5 -2 -1", "f 1 2 3 4294967297",
                             "f 1 2 99999999999999999999", "f 1 2 -99999999999999999999"}) {
        INFO(face);
        const support::Mesh mesh = load_obj(square_vertices + face + "\nf 1 2 3\n");
        CHECK(mesh.triangles.size() == 1);
        CHECK(mesh.drops.out_of_range_triangles == 1);
    }
}

TEST_CASE("negative indices count back from the vertices so far") {
    const support::Mesh mesh =
        load_obj(square_vertices + "f -4 -3 -2\nv 5 5 5\nv 6 5 5\nv 6 6 5\nf -3 -2 -1\n");
    REQUIRE(mesh.triangles.size() == 2);
    for (const std::uint32_t v : mesh.triangles[1]) CHECK(mesh.positions[v].z == 5);
}

TEST_CASE("points, lines and faces of less than three corners are counted") {
    const support::Mesh mesh =
        load_obj(square_vertices + "p 1 2 3\nl 1 2 3\nf 1 2\nf 1\nf 1 2 3\n");
    CHECK(mesh.triangles.size() == 1);
    CHECK(mesh.drops.points_and_lines == 6);
}

TEST_CASE("numbers and words for them are read as C does") {
    const support::Mesh mesh = load_obj(
        "v 1. .5 1e1\nv +1 -0 1.E+1\nv 0 1 0\nv NaN 0 0\nv 0 -Inf 0\nv 0 1e99 0\n"
        "f 1 2 3\nf 1 2 4\nf 1 2 5\nf 1 2 6\n");
    CHECK(mesh.triangles.size() == 1);
    CHECK(mesh.drops.nonfinite_vertices == 3);
    CHECK(mesh.drops.nonfinite_triangles == 3);
}

TEST_CASE("what makes no sense is refused with its line") {
    for (const auto& [text, line] : {std::pair{"v 0 0\n", "line 1"},
                                     {"\n\nv 0 0 x\n", "line 3"},
                                     {"v 0 0 0x1\n", "line 1"},
                                     {"v 1 2 3 4 5\n", "line 1"},
                                     {"v 1 \\\n2\\\nx\nf\n", "line 1"},
                                     {"w 1 2 3\n", "line 1"},
                                     {"V 1 2 3\n", "line 1"},
                                     {"v 0 0 0\nf 1 2 x\n", "line 2"},
                                     {"v 0 0 0\r\nf 1.5 2 3\r\n", "line 2"},
                                     {"v 0 0 0\rf 1/x/1 2 3\r", "line 2"},
                                     {"f 1 2 3 junk\n", "line 1"},
                                     {"vn 1 0\n", "line 1"},
                                     {"call other.obj\n", "line 1"},
                                     {"v 0 0 0\nv 0 0 0 \\", "line 2"},
                                     {"v 0 0 0 0 -1 0\n", "line 1"}}) {
        const std::string message = refusal("m.obj", text);
        INFO(text << " -> " << message);
        CHECK(contains(message, line));
    }
}

TEST_CASE("curves and surfaces are not drawn, and noted") {
    const support::Mesh mesh = load_obj(
        square_vertices + "cstype bezier\ndeg 3\ncurv 0 1 1 2 3 4\nparm u 0 1\nend\nf 1 2 3\n");
    CHECK(mesh.triangles.size() == 1);
    CHECK(has_note(mesh, "free-form"));
}

TEST_CASE("a normal that does not exist is made, and noted") {
    const support::Mesh mesh = load_obj(square_vertices + "vn 0 0 1\nf 1//1 2//2 3//0\n");
    REQUIRE(mesh.triangles.size() == 1);
    CHECK(has_note(mesh, "normal that does not exist, so that theirs is made: 2"));
}

TEST_CASE("vertex colours are sRGB, from 0 to 1 or to 255, with an opacity or without") {
    for (const char* colour : {"1 0.5019608 0", "255 128 0", "1 0.5019608 0 1", "255 128 0 255"}) {
        INFO(colour);
        const std::string tail = std::string(" ") + colour + "\n";
        const support::Mesh mesh =
            load_obj("v 0 0 0" + tail + "v 1 0 0" + tail + "v 0 1 0" + tail + "f 1 2 3\n");
        REQUIRE(mesh.colours.size() == 3);
        CHECK(std::abs(mesh.colours[0].r - 1) < 1e-6F);
        CHECK(std::abs(mesh.colours[0].g - 0.2158605F) < 1e-5F);
        CHECK(mesh.colours[0].b == 0);
        CHECK(std::abs(mesh.colours[0].a - 1) < 1e-6F);
    }
    const support::Mesh some = load_obj("v 0 0 0 255 0 0 51\nv 1 0 0\nv 0 1 0 0 0 255\nf 1 2 3\n");
    REQUIRE(some.colours.size() == 3);
    const auto colour_at = [&](const glm::vec3& p) {
        for (std::size_t i = 0; i < 3; ++i)
            if (some.positions[i] == p) return some.colours[i];
        return glm::vec4(-1);
    };
    CHECK(std::abs(colour_at({0, 0, 0}).a - 0.2F) < 1e-6F);
    CHECK(colour_at({1, 0, 0}) == glm::vec4(1));
    CHECK(colour_at({0, 1, 0}).a == 1);
}

TEST_CASE("a face of 100,000 corners in a line is refused or drawn, in good time") {
    std::string text, face = "f";
    for (int i = 0; i < 100000; ++i) {
        const double angle = i * 6.283185307179586 / 100000;
        text +=
            "v " + std::to_string(std::cos(angle)) + " " + std::to_string(std::sin(angle)) + " 0\n";
        face += " " + std::to_string(i + 1);
    }
    try {
        CHECK(load_obj(text + face + "\n" + square_vertices + "f -4 -3 -2\n").triangles.size() >=
              1);
    } catch (const support::InputError&) {}
}

}  // namespace
}  // namespace cellist::test
