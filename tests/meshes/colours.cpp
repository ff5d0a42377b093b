// SPDX-License-Identifier: MIT
// Colours of PLY and OFF files: bytes are sRGB, numbers with a fraction are linear.
#include <glm/vec4.hpp>

#include "meshes/support/loaded.hpp"
#include "meshes/support/odd_file.hpp"

namespace cellist::test {
namespace {

using support::Mesh;

bool near(float a, double b) { return std::abs(static_cast<double>(a) - b) < 1e-6; }

// 128 / 255 by the formula of IEC 61966-2-1.
constexpr double half_srgb = 0.21586050011389926;

TEST_CASE("bytes at the vertices of a PLY file are sRGB, the opacity is linear") {
    const Mesh mesh = load_text(
        "a.ply",
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
        "property float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
        "property uchar alpha\nelement face 1\nproperty list uchar int vertex_indices\n"
        "end_header\n0 0 0 255 128 0 51\n1 0 0 255 128 0 51\n0 1 0 255 128 0 51\n3 0 1 2\n");
    REQUIRE(mesh.colours.size() == 3);
    for (const glm::vec4& colour : mesh.colours) {
        CHECK(near(colour.r, 1));
        CHECK(near(colour.g, half_srgb));
        CHECK(near(colour.b, 0));
        CHECK(near(colour.a, 0.2));
    }
    // The file says all about the opacity.
    REQUIRE(mesh.materials.size() == 1);
    CHECK(mesh.materials[0].opacity == 1.0F);
    CHECK(mesh.triangle_materials == std::vector<std::uint32_t>{0});
}

TEST_CASE("floats at the vertices of a PLY file are linear") {
    const Mesh mesh = load_text(
        "a.ply",
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float red\nproperty float green\n"
        "property float blue\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
        "0.5 0.25 nan 0 0 0\n0.5 0.25 0 1 0 0\n0.5 0.25 -1 0 1 0\n3 0 1 2\n");
    REQUIRE(mesh.colours.size() == 3);
    for (const glm::vec4& colour : mesh.colours) CHECK(colour == glm::vec4(0.5, 0.25, 0, 1));
    CHECK(mesh.materials.empty());
}

TEST_CASE("vertices of one place and two colours stay two, and share their normal") {
    const Mesh mesh = load_text(
        "a.ply",
        "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\n"
        "property float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
        "element face 2\nproperty list uchar int vertex_indices\nend_header\n"
        "0 0 0 255 0 0\n1 0 0 255 0 0\n0 1 0 255 0 0\n"
        "0 0 0 0 0 255\n0 0 1 0 0 255\n1 0 0 0 0 255\n3 0 1 2\n3 3 4 5\n");
    CHECK(mesh.positions.size() == 6);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
        for (std::size_t k = 0; k < i; ++k)
            if (mesh.positions[i] == mesh.positions[k]) CHECK(mesh.normals[i] == mesh.normals[k]);
}

TEST_CASE("colours of faces become materials") {
    const Mesh ply = load_text(
        "a.ply",
        "ply\nformat ascii 1.0\nelement face 3\nproperty list uchar int vertex_indices\n"
        "property uchar red\nproperty uchar green\nproperty uchar blue\nelement vertex 4\n"
        "property float x\nproperty float y\nproperty float z\nend_header\n"
        "3 0 1 2 255 0 128\n3 0 2 3 0 0 0\n3 0 3 1 255 0 128\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n");
    REQUIRE(ply.materials.size() == 2);
    CHECK(ply.triangle_materials == std::vector<std::uint32_t>{0, 1, 0});
    CHECK(near(ply.materials[0].base_colour->b, half_srgb));
    CHECK(!ply.materials[0].opacity);

    const Mesh off = load_text("a.off",
                               "OFF\n4 3 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n"
                               "3 0 1 2 0.5 0.25 1 0.75\n3 0 2 3\n3 0 3 1 0.5 0.25 1 0.75\n");
    REQUIRE(off.materials.size() == 2);
    CHECK(off.triangle_materials == std::vector<std::uint32_t>{0, 1, 0});
    CHECK(*off.materials[0].base_colour == glm::vec3(0.5, 0.25, 1));
    CHECK(off.materials[0].opacity == 0.75F);
    CHECK(!off.materials[1].base_colour);
}

TEST_CASE("colours of OFF vertices may be bytes or fractions") {
    const Mesh bytes = load_text("a.off",
                                 "COFF\n3 1 0\n0 0 0 255 128 0 51\n1 0 0 255 128 0 51\n"
                                 "0 1 0 255 128 0 51\n3 0 1 2\n");
    REQUIRE(bytes.colours.size() == 3);
    CHECK(near(bytes.colours[0].g, half_srgb));
    CHECK(near(bytes.colours[0].a, 0.2));
    const Mesh fractions =
        load_text("a.off", "OFF\n3 1 0\n0 0 0 1 0.5 0\n1 0 0 1 0.5 0\n0 1 0 1 0.5 0\n3 0 1 2\n");
    REQUIRE(fractions.colours.size() == 3);
    CHECK(fractions.colours[0] == glm::vec4(1, 0.5, 0, 1));
}

}  // namespace
}  // namespace cellist::test
