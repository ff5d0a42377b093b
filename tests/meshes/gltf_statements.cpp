// SPDX-License-Identifier: MIT
// What a glTF file has besides triangles: skins, scenes, indices, extensions. Anything unsupported
// or inconsistent is refused with its place.
#include "meshes/support/gltf_text.hpp"
#include "meshes/support/loaded.hpp"

namespace cellist::test {
namespace {

// A square in the plane z = 0 as accessor 0, and its two triangles as accessor 1.
GltfScene square_scene() {
    GltfScene scene;
    scene.add_values(std::vector<float>{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, 5126, "VEC3", 3);
    scene.add_values(std::vector<std::uint16_t>{0, 1, 2, 0, 2, 3}, 5123, "SCALAR", 1);
    scene.add_primitive({{"attributes", {{"POSITION", 0}}}, {"indices", 1}});
    return scene;
}

json& primitive_of(GltfScene& scene) { return scene.root["meshes"][0]["primitives"][0]; }

support::Mesh load(const GltfScene& scene) { return load_text("m.gltf", scene.gltf()); }

float greatest(const support::Mesh& mesh, int axis) {
    float most = -1e30F;
    for (const glm::vec3& p : mesh.positions) most = std::max(most, p[axis]);
    return most;
}

// Loads the square after `change`, and checks that the message names the place.
void check_refused(const std::string& place, const std::function<void(GltfScene&)>& change) {
    GltfScene scene = square_scene();
    change(scene);
    const std::string message = refusal("m.gltf", scene.gltf());
    INFO(message);
    CHECK(contains(message, place));
}

TEST_CASE("a triangle with an index that does not exist is dropped and counted") {
    GltfScene scene = square_scene();
    primitive_of(scene)["indices"] = scene.add_values(
        std::vector<std::uint16_t>{0, 1, 2, 0, 2, 999, 0, 2, 65535}, 5123, "SCALAR", 1);
    const support::Mesh mesh = load(scene);
    CHECK(mesh.triangles.size() == 1);
    CHECK(mesh.drops.out_of_range_triangles == 2);
}

TEST_CASE("points and lines are counted") {
    GltfScene scene = square_scene();
    for (const int mode : {0, 1, 2, 3})
        scene.add_primitive({{"mode", mode}, {"attributes", {{"POSITION", 0}}}});
    CHECK(load(scene).drops.points_and_lines == 4 + 2 + 4 + 3);
}

TEST_CASE("joints place a skinned mesh, and its node does not") {
    GltfScene scene = square_scene();
    std::vector<std::uint8_t> joints;
    std::vector<float> weights;
    for (int v = 0; v < 4; ++v) {
        joints.insert(joints.end(), {0, 1, 0, 0});
        weights.insert(weights.end(), {0.25F, 0.75F, 0, 0});
    }
    primitive_of(scene)["attributes"]["JOINTS_0"] = scene.add_values(joints, 5121, "VEC4", 4);
    primitive_of(scene)["attributes"]["WEIGHTS_0"] = scene.add_values(weights, 5126, "VEC4", 4);
    json& nodes = scene.root["nodes"];
    nodes[0]["skin"] = 0;
    nodes[0]["translation"] = {0, 0, 100};
    nodes.push_back({{"translation", {0, 0, 4}}});
    nodes.push_back({{"translation", {0, 0, 8}}});
    scene.root["skins"] = {{{"joints", {1, 2}}}};
    SECTION("without inverse bind matrices") {
        const support::Mesh mesh = load(scene);
        CHECK(mesh.triangles.size() == 2);
        CHECK(greatest(mesh, 2) == 7);  // 0.25 * 4 + 0.75 * 8
    }
    SECTION("with inverse bind matrices") {
        std::vector<float> matrices;
        for (const float z : {-4.0F, -8.0F})
            matrices.insert(matrices.end(), {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, z, 1});
        scene.root["skins"][0]["inverseBindMatrices"] =
            scene.add_values(matrices, 5126, "MAT4", 16);
        CHECK(greatest(load(scene), 2) == 0);
    }
    SECTION("a joint that does not exist") {
        scene.root["skins"][0]["joints"] = {1};
        CHECK(contains(refusal("m.gltf", scene.gltf()), "JOINTS_0"));
    }
}

TEST_CASE("a mesh in several nodes is drawn in each") {
    GltfScene scene = square_scene();
    scene.root["nodes"].push_back({{"mesh", 0}, {"translation", {0, 0, 5}}});
    scene.root["scenes"][0]["nodes"].push_back(1);
    const support::Mesh mesh = load(scene);
    CHECK(mesh.triangles.size() == 4);
    CHECK(greatest(mesh, 2) == 5);
}

TEST_CASE("the default scene is drawn, or the first, or all nodes") {
    GltfScene scene = square_scene();
    scene.root["nodes"].push_back({{"mesh", 0}, {"translation", {0, 0, 5}}});
    scene.root["scenes"].push_back({{"nodes", {1, 0}}});
    CHECK(load(scene).triangles.size() == 2);
    CHECK(has_note(load(scene), "scene 0 of 2"));
    scene.root["scene"] = 1;
    CHECK(load(scene).triangles.size() == 4);
    scene.root.erase("scene");
    CHECK(load(scene).triangles.size() == 2);
    scene.root.erase("scenes");
    CHECK(load(scene).triangles.size() == 4);
}

TEST_CASE("extensions that a file requires are refused by name, others are noted") {
    for (const char* name : {"KHR_draco_mesh_compression", "EXT_meshopt_compression",
                             "EXT_mesh_gpu_instancing", "KHR_materials_transmission", "X_new"}) {
        GltfScene scene = square_scene();
        scene.root["extensionsUsed"] = {name};
        if (std::string(name).find("compression") == std::string::npos)
            CHECK(has_note(load(scene), name));
        scene.root["extensionsRequired"] = {name};
        const std::string message = refusal("m.gltf", scene.gltf());
        INFO(message);
        CHECK(contains(message, name));
    }
    for (const char* name : {"KHR_texture_transform", "KHR_materials_unlit", "EXT_texture_webp"}) {
        GltfScene scene = square_scene();
        scene.root["extensionsUsed"] = {name};
        scene.root["extensionsRequired"] = {name};
        CHECK(load(scene).notes.empty());
    }
}

TEST_CASE("values that do not fit one another are refused with their place") {
    check_refused("/nodes", [](GltfScene& s) { s.root["nodes"][0]["children"] = {0}; });
    check_refused("/nodes", [](GltfScene& s) {
        s.root["nodes"].push_back({{"children", {2}}});
        s.root["nodes"].push_back({{"children", {1}}});
    });
    check_refused("/nodes/2", [](GltfScene& s) {
        s.root["nodes"].push_back({{"children", {0}}});
        s.root["nodes"].push_back({{"children", {0}}});
    });
    check_refused("/nodes/0/mesh", [](GltfScene& s) { s.root["nodes"][0]["mesh"] = 1; });
    check_refused("/nodes/0/matrix", [](GltfScene& s) { s.root["nodes"][0]["matrix"] = {1, 2}; });
    check_refused("/nodes/0/rotation", [](GltfScene& s) {
        s.root["nodes"][0]["rotation"] = {0, 0, 0, 0};
    });
    check_refused("/scenes/0", [](GltfScene& s) { s.root["scenes"][0]["nodes"] = {0, 0}; });
    check_refused("/scene", [](GltfScene& s) { s.root["scene"] = -1; });
    check_refused("/meshes/0/primitives/0/attributes/POSITION",
                  [](GltfScene& s) { primitive_of(s)["attributes"]["POSITION"] = 2; });
    check_refused("/accessors/0/type",
                  [](GltfScene& s) { s.root["accessors"][0]["type"] = "VEC2"; });
    check_refused("/accessors/0/componentType",
                  [](GltfScene& s) { s.root["accessors"][0]["componentType"] = 5122; });
    check_refused("/accessors/1/componentType",
                  [](GltfScene& s) { s.root["accessors"][1]["componentType"] = 5122; });
    check_refused("/accessors/0", [](GltfScene& s) { s.root["accessors"][0]["count"] = 5; });
    check_refused("/accessors/0",
                  [](GltfScene& s) { s.root["accessors"][0]["count"] = 4294967295U; });
    check_refused("/accessors/0", [](GltfScene& s) {
        s.root["accessors"][0].erase("bufferView");
        s.root["accessors"][0]["count"] = 4000000000U;
    });
    check_refused("/accessors/0/sparse/indices", [](GltfScene& s) {
        s.root["accessors"][0]["sparse"] = {
            {"count", 4},
            {"indices", {{"bufferView", 1}, {"componentType", 5125}}},
            {"values", {{"bufferView", 0}}}};
    });
    check_refused("/bufferViews/0",
                  [](GltfScene& s) { s.root["bufferViews"][0]["byteLength"] = 1000; });
    check_refused("/bufferViews/0",
                  [](GltfScene& s) { s.root["bufferViews"][0]["byteStride"] = 4; });
    check_refused("/meshes/0/primitives/0",
                  [](GltfScene& s) { s.root["accessors"][1]["count"] = 5; });
    check_refused("/meshes/0/primitives/0/mode", [](GltfScene& s) { primitive_of(s)["mode"] = 7; });
    check_refused("/meshes/0/primitives/0/attributes/NORMAL", [](GltfScene& s) {
        primitive_of(s)["attributes"]["NORMAL"] =
            s.add_values(std::vector<float>{0, 0, 1}, 5126, "VEC3", 3);
    });
    check_refused("/asset", [](GltfScene& s) { s.root["asset"] = {{"version", "1.0"}}; });
    check_refused("'asset'", [](GltfScene& s) { s.root.erase("asset"); });
    check_refused("/materials/0/alphaMode", [](GltfScene& s) {
        s.root["materials"] = {{{"alphaMode", "HALF"}}};
    });
}

TEST_CASE("lengths in a GLB file that do not fit are refused, bytes after its end are counted") {
    const std::string glb = square_scene().glb();
    for (const std::size_t at :
         {std::size_t{4}, std::size_t{8}, std::size_t{12}, std::size_t{16}}) {
        std::string changed = glb;
        changed[at + 1] = '\x7F';
        (void)refusal("m.glb", changed);
    }
    const support::Mesh mesh = load_text("m.glb", glb + "more");
    CHECK(mesh.triangles.size() == 2);
    CHECK(mesh.drops.bytes_after_end == 4);
}

}  // namespace
}  // namespace cellist::test
