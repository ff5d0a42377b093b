// SPDX-License-Identifier: MIT
// Meshes of several formats are loaded whole, and what cannot be drawn is counted.
#include <cmath>

#include <glm/geometric.hpp>

#include "input_error.hpp"
#include "oit/support/files.hpp"
#include "oit/support/procedural.hpp"
#include "support/catch.hpp"
#include "support/errors.hpp"

namespace cellist::test {
namespace {

using support::InputError;
using support::load_mesh;
using support::Mesh;

std::string ply_header(int vertices, int faces) {
    return "ply\nformat ascii 1.0\nelement vertex " + std::to_string(vertices) +
           "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
           std::to_string(faces) + "\nproperty list uchar int vertex_indices\nend_header\n";
}

TEST_CASE("OBJ, PLY and STL files give the same mesh") {
    const Folder folder;
    const Mesh knot = torus_knot(2, 3, 60, 8);
    for (const auto& path :
         {folder.write("a.obj", obj_text(knot)), folder.write("a.ply", ply_text(knot)),
          folder.write("b.ply", ply_binary(knot)), folder.write("a.stl", stl_binary(knot))}) {
        INFO(path.filename().string());
        const Mesh loaded = load_mesh(path);
        CHECK(loaded.triangles.size() == knot.triangles.size());
        CHECK(loaded.positions.size() == knot.positions.size());
        CHECK(loaded.drops.triangles() == 0);
        CHECK(loaded.normals.size() == loaded.positions.size());
        // The knot is smooth, so the normals that were made are near those of the tube.
        for (std::size_t i = 0; i < loaded.normals.size(); ++i)
            REQUIRE(std::abs(glm::length(loaded.normals[i]) - 1) < 1e-5F);
    }
}

TEST_CASE("nodes of a glTF scene are placed by their transforms") {
    const Folder folder;
    std::string bytes;
    for (const glm::vec3& p : {glm::vec3(0, 0, 0), glm::vec3(1, 0, 0), glm::vec3(0, 1, 0)})
        append_bytes(bytes, p);
    (void)folder.write("m.bin", bytes);
    const auto path = folder.write("m.gltf", R"({"asset":{"version":"2.0"},"scene":0,
        "scenes":[{"nodes":[0,1]}],
        "nodes":[{"mesh":0},{"translation":[10,0,0],"children":[2]},{"mesh":0,"scale":[-2,1,1]}],
        "meshes":[{"primitives":[{"attributes":{"POSITION":0},"mode":4}]}],
        "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3",
                      "min":[0,0,0],"max":[1,1,0]}],
        "bufferViews":[{"buffer":0,"byteLength":36}],
        "buffers":[{"uri":"m.bin","byteLength":36}]})");
    const Mesh mesh = load_mesh(path);
    REQUIRE(mesh.triangles.size() == 2);
    float least = 100, greatest = -100;
    for (const glm::vec3& p : mesh.positions) {
        least = std::min(least, p.x);
        greatest = std::max(greatest, p.x);
    }
    CHECK(least == 0);
    CHECK(greatest == 10);
    // The mirrored copy still runs counter-clockwise around its normal, which mirrors along x: +z.
    for (const auto& t : mesh.triangles)
        CHECK(glm::cross(mesh.positions[t[1]] - mesh.positions[t[0]],
                         mesh.positions[t[2]] - mesh.positions[t[0]])
                  .z > 0);
}

TEST_CASE("polygons are triangulated, points and lines are counted") {
    const Folder folder;
    const Mesh mesh = load_mesh(folder.write(
        "p.obj",
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0.5 2 0\np 1\nl 1 2\nf 1 2 3 4\nf 4 3 5\n"));
    CHECK(mesh.triangles.size() == 3);
    CHECK(mesh.drops.points_and_lines == 2);
}

TEST_CASE("triangles with NaN or infinite vertices are dropped and counted") {
    const Folder folder;
    const Mesh mesh = load_mesh(folder.write(
        "n.ply",
        ply_header(5, 3) + "0 0 0\n1 0 0\n0 1 0\nnan 0 0\n0 inf 0\n3 0 1 2\n3 0 1 3\n3 0 4 2\n"));
    CHECK(mesh.triangles.size() == 1);
    CHECK(mesh.drops.nonfinite_vertices == 2);
    CHECK(mesh.drops.nonfinite_triangles == 2);
}

TEST_CASE("triangles with indices out of range or equal corners are dropped and counted") {
    const Folder folder;
    const Mesh mesh = load_mesh(folder.write(
        "i.ply", ply_header(3, 3) + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n3 0 1 3\n3 0 1 1\n"));
    CHECK(mesh.triangles.size() == 1);
    CHECK(mesh.drops.out_of_range_triangles == 1);
    CHECK(mesh.drops.degenerate_triangles == 1);
}

TEST_CASE("truncated files are refused wherever they are cut") {
    const Folder folder;
    const Mesh knot = torus_knot(2, 3, 40, 6);
    const std::string text = ply_text(knot), bytes = ply_binary(knot), stl = stl_binary(knot);
    for (const double part : {0.001, 0.01, 0.3, 0.6, 0.95}) {
        INFO("part " << part);
        const auto cut = [part](const std::string& whole) {
            return whole.substr(
                0, std::max<std::size_t>(
                       8, static_cast<std::size_t>(part * static_cast<double>(whole.size()))));
        };
        CHECK_THROWS_AS(load_mesh(folder.write("t.ply", cut(text))), InputError);
        CHECK_THROWS_AS(load_mesh(folder.write("b.ply", cut(bytes))), InputError);
        CHECK_THROWS_AS(load_mesh(folder.write("t.stl", cut(stl))), InputError);
    }
    CHECK_THROWS_AS(load_mesh(folder.write("t.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2")),
                    InputError);
    CHECK(load_mesh(folder.write("u.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3")).ends_within_line);
}

TEST_CASE("files that hold no mesh are refused with their name") {
    const Folder folder;
    for (const auto& [name, text] : {std::pair{"empty.obj", ""},
                                     {"empty.ply", ""},
                                     {"garbage.obj", "hello world, this is no mesh"},
                                     {"garbage.ply", "hello world"},
                                     {"garbage.stl", "hello"},
                                     {"garbage.gltf", "{"},
                                     {"unknown.xyzzy", "hello"},
                                     {"points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\np 1\n"}}) {
        const auto path = folder.write(name, text);
        const auto error = error_of<InputError>([&] { (void)load_mesh(path); });
        INFO(error.what());
        CHECK(contains(error.what(), name));
    }
    CHECK_THROWS_AS(load_mesh(folder / "missing.obj"), InputError);
    CHECK_THROWS_AS(load_mesh(folder / "."), InputError);
}

TEST_CASE("meshes of any scale and place fit in the unit sphere") {
    for (const float scale : {1e-30F, 1.0F, 1e30F}) {
        INFO("scale " << scale);
        Mesh mesh;
        for (const glm::vec3& p : torus_knot(2, 3, 30, 6).positions)
            mesh.positions.push_back(scale * (p + glm::vec3(3, -4, 5)));
        support::fit_to_unit_sphere(mesh);
        float farthest = 0;
        for (const glm::vec3& p : mesh.positions) farthest = std::max(farthest, glm::length(p));
        CHECK(farthest <= 1.00001F);
        CHECK(farthest > 0.9F);
    }
}

}  // namespace
}  // namespace cellist::test
