// SPDX-License-Identifier: MIT
// Base colours and opacities from MTL files, glTF files and the formats that Assimp reads.
#include <cmath>

#include "meshes/support/gltf_text.hpp"
#include "meshes/support/loaded.hpp"

namespace cellist::test {
namespace {

using support::MeshMaterial;

constexpr const char* obj_corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

support::Mesh load_with_mtl(const std::string& obj, const std::string& mtl) {
    const Folder folder;
    (void)folder.write("m.mtl", mtl);
    return support::load_mesh(folder.write("m.obj", "mtllib m.mtl\n" + (obj_corners + obj)));
}

MeshMaterial material_of_only(const support::Mesh& mesh) {
    REQUIRE(mesh.triangles.size() == 1);
    REQUIRE(mesh.triangle_materials.size() == 1);
    return mesh.materials.at(mesh.triangle_materials[0]);
}

TEST_CASE("an MTL file gives base colour and opacity") {
    struct Case {
        const char* mtl;
        std::optional<glm::vec3> colour;
        std::optional<float> opacity;
    };
    const glm::vec3 red(1, 0.25F, 0);
    for (const Case& c :
         {Case{"newmtl a\nKd 1 0.25 0\nd 0.25\n", red, 0.25F},
          Case{"  newmtl  a \r\n\tKd 1 .25 0 # red\r\n Tr 0.25\r\n", red, 0.75F},
          Case{"newmtl a\nTr 0.25\nd 0.5\n", {}, 0.5F},
          Case{"newmtl a\nd 0.5\nTr 0.25\n", {}, 0.5F}, Case{"newmtl a\nd -halo 0.5\n", {}, 0.5F},
          Case{"newmtl a\nKd 0.5\n", glm::vec3(0.5F), {}},
          Case{"newmtl a\nKd 1 \\\n 0.25 0\n", red, {}},
          Case{"newmtl b\nKd 0 0 1\nnewmtl a\nKs 1 1 1\nillum 2\n", {}, {}},
          Case{"newmtl a\nKd 1 0.25 0\nnewmtl a\nKd 0 0 1\nd 0.5\n", red, {}}}) {
        INFO(c.mtl);
        const MeshMaterial material = material_of_only(load_with_mtl("usemtl a\nf 1 2 3\n", c.mtl));
        CHECK(material.base_colour == c.colour);
        CHECK(material.opacity == c.opacity);
    }
}

TEST_CASE("faces take the material of the last usemtl, whatever the groups") {
    const support::Mesh mesh =
        load_with_mtl("f 1 2 3\nusemtl wood #2\ng x\nf 3 2 1\nusemtl a # comment\nf 2 3 1\n",
                      "newmtl a\nd 0.5\nnewmtl wood #2\nd 0.25\n");
    REQUIRE(mesh.triangle_materials.size() == 3);
    const auto opacity = [&](std::size_t i) {
        return mesh.materials.at(mesh.triangle_materials[i]).opacity;
    };
    CHECK(opacity(0) == std::nullopt);
    CHECK(opacity(1) == 0.25F);
    CHECK(opacity(2) == 0.5F);
    CHECK(mesh.notes.empty());
}

TEST_CASE("materials and material files that do not exist are noted") {
    const Folder folder;
    const support::Mesh mesh = support::load_mesh(folder.write(
        "m.obj", std::string("mtllib no.mtl\nusemtl a\n") + obj_corners + "f 1 2 3\n"));
    CHECK(has_note(mesh, "no.mtl"));
    CHECK(has_note(mesh, "'a'"));
    CHECK(material_of_only(mesh).opacity == std::nullopt);
}

TEST_CASE("mtllib names one file with blanks, or several files") {
    const Folder folder;
    (void)folder.write("my own.mtl", "newmtl a\nd 0.25\n");
    (void)folder.write("other.mtl", "newmtl b\nd 0.5\n");
    const support::Mesh mesh = support::load_mesh(
        folder.write("m.obj", std::string("mtllib my own.mtl\nmtllib other.mtl none.mtl\n") +
                                  obj_corners + "usemtl a\nf 1 2 3\nusemtl b\nf 3 2 1\n"));
    REQUIRE(mesh.triangle_materials.size() == 2);
    CHECK(mesh.materials.at(mesh.triangle_materials[0]).opacity == 0.25F);
    CHECK(mesh.materials.at(mesh.triangle_materials[1]).opacity == 0.5F);
    CHECK(has_note(mesh, "none.mtl"));
}

TEST_CASE("a damaged MTL file is refused with its line, one that may be cut off is noted") {
    const Folder folder;
    const auto path =
        folder.write("m.obj", std::string("mtllib m.mtl\nusemtl a\n") + obj_corners + "f 1 2 3\n");
    for (const char* bad :
         {"Kd 1 0", "Kd 1 0 x", "Kd spectral a.rfl", "d", "d nan", "d -1", "Tr a"}) {
        (void)folder.write("m.mtl", std::string("newmtl a\n") + bad + "\n");
        const auto error = error_of<support::InputError>([&] { (void)support::load_mesh(path); });
        INFO(bad << " -> " << error.what());
        CHECK(contains(error.what(), "m.mtl', line 2"));
    }
    (void)folder.write("m.mtl", "newmtl a\nd 0.2");
    CHECK(has_note(support::load_mesh(path), "may be cut off"));
}

TEST_CASE("textures of colour and opacity are counted for materials that faces use") {
    const support::Mesh mesh = load_with_mtl(
        "usemtl a\nf 1 2 3\n",
        "newmtl a\nmap_Kd a.png\nmap_d -s 1 1 1 b.png\nmap_Bump c.png\nnewmtl b\nmap_Kd d.png\n");
    CHECK(mesh.ignored_textures == 2);
}

// A triangle with a material of this JSON.
GltfScene triangle_of(const json& material) {
    GltfScene scene;
    scene.add_values(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0}, 5126, "VEC3", 3);
    scene.root["materials"] = {material};
    scene.add_primitive({{"attributes", {{"POSITION", 0}}}, {"material", 0}});
    return scene;
}

TEST_CASE("a glTF material gives base colour, and the opacity of its alpha mode") {
    const json factor = {{"baseColorFactor", {1, 0.25, 0, 0.25}}};
    struct Case {
        json material;
        glm::vec3 colour;
        float opacity;
    };
    const glm::vec3 red(1, 0.25F, 0);
    for (const Case& c :
         {Case{{{"pbrMetallicRoughness", factor}}, red, 1},
          Case{{{"pbrMetallicRoughness", factor}, {"alphaMode", "OPAQUE"}}, red, 1},
          Case{{{"pbrMetallicRoughness", factor}, {"alphaMode", "BLEND"}}, red, 0.25F},
          Case{{{"pbrMetallicRoughness", factor}, {"alphaMode", "MASK"}, {"alphaCutoff", 0.25}},
               red,
               1},
          Case{json::object(), glm::vec3(1), 1},
          Case{{{"alphaMode", "BLEND"},
                {"extensions",
                 {{"KHR_materials_pbrSpecularGlossiness", {{"diffuseFactor", {0, 0, 1, 0.5}}}}}}},
               glm::vec3(0, 0, 1),
               0.5F}}) {
        INFO(c.material.dump());
        const MeshMaterial material =
            material_of_only(load_text("m.glb", triangle_of(c.material).glb()));
        CHECK(material.base_colour == c.colour);
        CHECK(material.opacity == c.opacity);
    }
}

TEST_CASE("a primitive without a material says nothing of its opacity") {
    GltfScene scene = triangle_of(json::object());
    scene.root["meshes"][0]["primitives"][0].erase("material");
    CHECK(material_of_only(load_text("m.glb", scene.glb())).opacity == std::nullopt);
    scene.root.erase("materials");
    CHECK(load_text("m.glb", scene.glb()).triangle_materials.empty());
}

TEST_CASE("triangles below their material's alpha cutoff are not drawn, and noted") {
    GltfScene scene = triangle_of(
        {{"alphaMode", "MASK"}, {"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, 0.25}}}}});
    scene.add_primitive({{"attributes", {{"POSITION", 0}}}});
    const support::Mesh mesh = load_text("m.glb", scene.glb());
    CHECK(mesh.triangles.size() == 1);
    CHECK(has_note(mesh, "cutoff"));
}

TEST_CASE("glTF vertex colours are linear factors, and their alpha counts where it blends") {
    for (const char* mode : {"OPAQUE", "BLEND"}) {
        GltfScene scene = triangle_of({{"alphaMode", mode}});
        std::vector<std::uint8_t> colours;
        for (int i = 0; i < 3; ++i) colours.insert(colours.end(), {255, 51, 0, 102});
        const std::size_t accessor = scene.add_values(colours, 5121, "VEC4", 4);
        scene.root["accessors"][accessor]["normalized"] = true;
        scene.root["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = accessor;
        const support::Mesh mesh = load_text("m.glb", scene.glb());
        REQUIRE(mesh.colours.size() == 3);
        CHECK(mesh.colours[0] == glm::vec4(1, 0.2F, 0, std::string(mode) == "BLEND" ? 0.4F : 1.0F));
    }
}

TEST_CASE("base colour textures of glTF materials that are drawn are counted") {
    GltfScene scene =
        triangle_of({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
    scene.root["materials"].push_back(scene.root["materials"][0]);
    CHECK(load_text("m.glb", scene.glb()).ignored_textures == 1);
}

}  // namespace
}  // namespace cellist::test
