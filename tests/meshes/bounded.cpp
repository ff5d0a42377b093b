// SPDX-License-Identifier: MIT
// Small files that ask for much depth, work or memory are refused, or drawn, in good time.
#include "meshes/support/gltf_text.hpp"
#include "meshes/support/loaded.hpp"

namespace cellist::test {
namespace {

std::string repeated(const std::string& text, std::size_t count) {
    std::string out;
    for (std::size_t i = 0; i < count; ++i) out += text;
    return out;
}

GltfScene scene_of_triangle() {
    GltfScene scene;
    scene.add_values(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0}, 5126, "VEC3", 3);
    scene.add_primitive({{"attributes", {{"POSITION", 0}}}});
    return scene;
}

TEST_CASE("JSON that is nested deeply is refused") {
    for (const auto& [open, close] : {std::pair{"[", "]"}, {"{\"a\":", "}"}}) {
        std::string text = scene_of_triangle().gltf();
        text.pop_back();
        text += ",\"extras\":" + repeated(open, 200000) + "1" + repeated(close, 200000) + "}";
        CHECK(contains(refusal("m.gltf", text), "nested 200001 levels"));
    }
    CHECK(contains(refusal("m.gltf", repeated("[", 300000)), "nested"));
}

TEST_CASE("nodes may be nested deeply") {
    GltfScene scene = scene_of_triangle();
    constexpr std::size_t depth = 50000;
    json nodes = json::array();
    for (std::size_t i = 0; i < depth; ++i)
        nodes.push_back({{"children", {i + 1}}, {"translation", {0.5, 0, 0}}});
    nodes.push_back({{"mesh", 0}});
    scene.root["nodes"] = nodes;
    const support::Mesh mesh = load_text("m.gltf", scene.gltf());
    REQUIRE(mesh.triangles.size() == 1);
    float most = 0;
    for (const glm::vec3& p : mesh.positions) most = std::max(most, p.x);
    CHECK(most == depth / 2 + 1);
}

TEST_CASE("instances that multiply a mesh beyond all measure are refused") {
    GltfScene scene = scene_of_triangle();
    const std::vector<std::uint8_t> indices(30000, 0);
    const std::size_t accessor = scene.add_values(indices, 5121, "SCALAR", 1);
    json primitives = json::array();
    for (int i = 0; i < 1000; ++i)
        primitives.push_back({{"attributes", {{"POSITION", 0}}}, {"indices", accessor}});
    scene.root["meshes"][0]["primitives"] = primitives;
    scene.root["nodes"] = json::array();
    scene.root["scenes"][0]["nodes"] = json::array();
    for (int i = 0; i < 1000; ++i) {
        scene.root["nodes"].push_back({{"mesh", 0}});
        scene.root["scenes"][0]["nodes"].push_back(i);
    }
    CHECK(contains(refusal("m.glb", scene.glb()), "the limit"));
}

}  // namespace
}  // namespace cellist::test
