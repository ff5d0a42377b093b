// SPDX-License-Identifier: MIT
// Assimp's formats load with their transforms and materials. A file that Assimp cannot read is an
// error.
#include <cmath>
#include <cstdint>

#include <glm/geometric.hpp>

#include "meshes/support/loaded.hpp"

namespace cellist::test {
namespace {

std::string collada(const std::string& image = "") {
    return R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><up_axis>Z_UP</up_axis></asset>)" +
           image +
           R"(<library_effects><effect id="e"><profile_COMMON><technique sid="c"><phong>
<diffuse><color>1 0.5 0 1</color></diffuse><transparency><float>0.25</float></transparency>
</phong></technique></profile_COMMON></effect></library_effects>
<library_materials><material id="m"><instance_effect url="#e"/></material></library_materials>
<library_geometries><geometry id="g"><mesh><source id="p">
<float_array id="pa" count="12">0 0 0 4 0 0 1 1 0 0 4 0</float_array><technique_common>
<accessor source="#pa" count="4" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<polylist count="1" material="m">
<input semantic="VERTEX" source="#v" offset="0"/><vcount>4</vcount><p>0 1 2 3</p></polylist></mesh>
</geometry></library_geometries><library_visual_scenes><visual_scene id="s"><node>
<translate>0 0 7</translate><instance_geometry url="#g"><bind_material><technique_common>
<instance_material symbol="m" target="#m"/></technique_common></bind_material></instance_geometry>
</node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>)";
}

TEST_CASE("a concave polygon of a COLLADA file is placed, split right and has its material") {
    const support::Mesh mesh = load_text("m.dae", collada());
    REQUIRE(mesh.triangles.size() == 2);
    CHECK(mesh.up == support::UpAxis::y);
    double area = 0;
    for (const auto& t : mesh.triangles) {
        for (const std::uint32_t v : t) CHECK(mesh.positions[v].y == 7);  // z was up
        area += 0.5 * static_cast<double>(
                          glm::length(glm::cross(mesh.positions[t[1]] - mesh.positions[t[0]],
                                                 mesh.positions[t[2]] - mesh.positions[t[0]])));
    }
    CHECK(std::abs(area - 4) < 1e-6);
    REQUIRE(mesh.triangle_materials.size() == 2);
    const support::MeshMaterial& material = mesh.materials.at(mesh.triangle_materials[0]);
    CHECK(material.base_colour == glm::vec3(1, 0.5F, 0));
    CHECK(material.opacity == 0.25F);
}

std::string chunk(std::uint16_t id, const std::string& bytes) {
    std::string out;
    append_bytes(out, id);
    append_bytes(out, static_cast<std::uint32_t>(6 + bytes.size()));
    return out + bytes;
}

template <class... T>
std::string packed(T... values) {
    std::string out;
    (append_bytes(out, values), ...);
    return out;
}

TEST_CASE("a 3DS file has its materials, and is refused where it is cut") {
    const auto u16 = [](int value) { return static_cast<std::uint16_t>(value); };
    const std::string name = std::string("red") + '\0';
    const std::string colour = chunk(0x11, {'\xFF', '\0', '\0'});
    const std::string material = chunk(0xAFFF, chunk(0xA000, name) + chunk(0xA020, colour) +
                                                   chunk(0xA050, chunk(0x30, packed(u16(75)))));
    const std::string vertices =
        chunk(0x4110, packed(u16(3), 0.0F, 0.0F, 0.0F, 1.0F, 0.0F, 0.0F, 0.0F, 1.0F, 0.0F));
    const std::string faces = chunk(0x4120, packed(u16(1), u16(0), u16(1), u16(2), u16(7)) +
                                                chunk(0x4130, name + packed(u16(1), u16(0))));
    const std::string object = chunk(0x4000, name + chunk(0x4100, vertices + faces));
    const std::string file = chunk(0x4D4D, chunk(0x3D3D, material + object));

    const support::Mesh mesh = load_text("m.3ds", file);
    REQUIRE(mesh.triangles.size() == 1);
    REQUIRE(mesh.triangle_materials.size() == 1);
    const support::MeshMaterial& found = mesh.materials.at(mesh.triangle_materials[0]);
    CHECK(found.base_colour == glm::vec3(1, 0, 0));
    REQUIRE(found.opacity.has_value());
    CHECK(std::abs(*found.opacity - 0.25F) < 1e-6F);
    for (std::size_t size = 1; size < file.size(); size += 23)
        (void)refusal("m.3ds", file.substr(0, size));
}

TEST_CASE("other formats under a name for Assimp are refused, and unknown ones") {
    (void)refusal("m.dae", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    (void)refusal("m.xyzzy", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    (void)refusal("m.3ds", "hello");
}

}  // namespace
}  // namespace cellist::test
