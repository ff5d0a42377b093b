// SPDX-License-Identifier: MIT
// Of the files that a mesh file names, only those in its folder are read. Messages show nothing of
// others.
#include "meshes/support/gltf_text.hpp"
#include "meshes/support/loaded.hpp"

namespace cellist::test {
namespace {

// A folder with a file, and in it a folder for meshes, which is emptied first.
struct Place {
    Folder outer;
    std::filesystem::path inner = outer / "meshes";
    Place() { std::filesystem::create_directory(inner); }
};

const std::string red_triangle = "usemtl a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

TEST_CASE("material files outside of the mesh's folder are not read, and noted") {
    const Place place;
    const auto secret = place.outer.write("secret.mtl", "newmtl a\nd 0.25\nKd top secret\n");
    std::filesystem::create_symlink(secret, place.inner / "link.mtl");
    for (const std::string& name :
         {std::string("../secret.mtl"), secret.string(), std::string("./x/../../secret.mtl"),
          std::string("link.mtl"), std::string("..\\secret.mtl"), std::string("/dev/zero")}) {
        INFO(name);
        const support::Mesh mesh = support::load_mesh(
            place.outer.write("meshes/m.obj", "mtllib " + name + "\n" + red_triangle));
        REQUIRE(mesh.triangles.size() == 1);
        CHECK(has_note(mesh, "is not in the mesh's folder"));
        CHECK(!has_note(mesh, "top"));
        CHECK(mesh.materials.at(0).opacity == std::nullopt);
    }
}

TEST_CASE("material files in the folder are read by any path that stays there") {
    const Place place;
    std::filesystem::create_directory(place.inner / "sub");
    (void)place.outer.write("meshes/sub/a.mtl", "newmtl a\nd 0.25\n");
    for (const char* name : {"sub/a.mtl", "sub\\a.mtl", "./sub/../sub/a.mtl"}) {
        INFO(name);
        const support::Mesh mesh = support::load_mesh(
            place.outer.write("meshes/m.obj", std::string("mtllib ") + name + "\n" + red_triangle));
        CHECK(mesh.materials.at(0).opacity == 0.25F);
    }
}

TEST_CASE("buffers outside of the mesh's folder, or of the network, are refused") {
    const Place place;
    GltfScene scene;
    scene.add_values(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0}, 5126, "VEC3", 3);
    scene.add_primitive({{"attributes", {{"POSITION", 0}}}});
    const auto outside = place.outer.write("b.bin", scene.buffer);
    std::filesystem::create_symlink(outside, place.inner / "link.bin");
    for (const std::string& uri :
         {std::string("../b.bin"), std::string("%2e%2e/b.bin"), outside.string(),
          "file://" + outside.string(), std::string("http://localhost/b.bin"),
          std::string("link.bin"), std::string("none.bin"), std::string("."), std::string("%00"),
          std::string("data:,")}) {
        const auto path = place.outer.write("meshes/m.gltf", scene.gltf(uri));
        const auto error = error_of<support::InputError>([&] { (void)support::load_mesh(path); });
        INFO(uri << " -> " << error.what());
        CHECK(contains(error.what(), "/buffers/0"));
    }
    (void)place.outer.write("meshes/my buffer.bin", scene.buffer);
    for (const char* uri : {"my%20buffer.bin", "my buffer.bin", "./my%20buffer.bin"})
        CHECK(support::load_mesh(place.outer.write("meshes/m.gltf", scene.gltf(uri)))
                  .triangles.size() == 1);
    (void)place.outer.write("meshes/my buffer.bin", scene.buffer.substr(1));
    const auto path = place.outer.write("meshes/m.gltf", scene.gltf("my%20buffer.bin"));
    CHECK_THROWS_AS(support::load_mesh(path), support::InputError);
}

}  // namespace
}  // namespace cellist::test
