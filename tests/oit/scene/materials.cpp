// SPDX-License-Identifier: MIT
// Base colours and opacities that a mesh file gives are drawn, and meshes share a picture.
#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include <glm/geometric.hpp>

#include "camera.hpp"
#include "frame_options.hpp"
#include "input_error.hpp"
#include "methods/renderer.hpp"
#include "oit/support/files.hpp"
#include "oit/support/procedural.hpp"
#include "options.hpp"
#include "reference/comparison.hpp"
#include "support/catch.hpp"
#include "support/device.hpp"
#include "support/errors.hpp"

namespace cellist::test {
namespace {

using glm::dvec3;
using glm::vec3;
using support::Mesh;

constexpr int side = 41;
constexpr std::size_t middle = side * (side / 2) + side / 2;
constexpr std::size_t left_of_middle = side * (side / 2);

// A square that faces the eye, of a material.
void add_square(Mesh& mesh, float half, float z, const support::MeshMaterial& material) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const float y : {-half, half})
        for (const float x : {-half, half}) {
            mesh.positions.emplace_back(x, y, z);
            mesh.normals.emplace_back(0.0F, 0.0F, 1.0F);
        }
    mesh.triangles.push_back({first, first + 1, first + 3});
    mesh.triangles.push_back({first, first + 3, first + 2});
    for (int i = 0; i < 2; ++i)
        mesh.triangle_materials.push_back(static_cast<std::uint32_t>(mesh.materials.size()));
    mesh.materials.push_back(material);
}

std::vector<cl_float4> picture_of(const oit::Scene& scene) {
    const oit::Frame frame{.scene = scene,
                           .views = {support::frame_unit_sphere({0, 0}, side, side)}};
    oit::Renderer renderer(device(), frame);
    renderer.draw();
    return renderer.image();
}

dvec3 colour(const cl_float4& pixel) { return vec3(pixel.s[0], pixel.s[1], pixel.s[2]); }

bool are_close(const dvec3& a, const dvec3& b) { return glm::length(a - b) < 1e-5; }

// A square alone, opaque: what its colour is.
dvec3 colour_alone(float half, float z, support::MeshMaterial material) {
    material.opacity = 1;
    Mesh mesh;
    add_square(mesh, half, z, material);
    const oit::Scene scene = oit::scene_of(mesh, 0.1F);
    CHECK(scene.is_opaque(scene.instances.front()));
    return colour(picture_of(scene)[middle]);
}

TEST_CASE("colours and opacities of a file blend by the over operator, in linear light") {
    const support::MeshMaterial red{.name = "r", .base_colour = vec3(1, 0, 0), .opacity = 0.2F},
        green{.name = "g", .base_colour = vec3(0, 1, 0), .opacity = 0.5F},
        blue{.name = "b", .base_colour = vec3(0, 0, 1), .opacity = 0.9F};
    Mesh mesh;
    add_square(mesh, 0.7F, -0.4F, blue);
    add_square(mesh, 0.5F, 0.4F, red);
    add_square(mesh, 0.6F, 0, green);
    const std::vector<cl_float4> image = picture_of(oit::scene_of(mesh, 0.35F));
    const dvec3 in_red = colour_alone(0.5F, 0.4F, red), in_green = colour_alone(0.6F, 0, green),
                in_blue = colour_alone(0.7F, -0.4F, blue), behind = colour(image[left_of_middle]);
    CHECK(in_red.x > in_red.y + 0.5);
    CHECK(in_green.y > in_green.z + 0.5);
    CHECK(in_blue.z > in_blue.x + 0.5);
    const dvec3 expected =
        0.2 * in_red + 0.8 * (0.5 * in_green + 0.5 * (0.9 * in_blue + 0.1 * behind));
    CHECK(are_close(colour(image[middle]), expected));
}

TEST_CASE("opaque surfaces of a file hide what is behind, and --alpha is for the others") {
    Mesh mesh;
    add_square(mesh, 0.4F, 0.5F, {.name = "nothing said", .base_colour = {}, .opacity = {}});
    add_square(mesh, 0.5F, 0, {.name = "wall", .base_colour = vec3(0.5F), .opacity = 1.0F});
    add_square(mesh, 0.6F, -0.5F, {.name = "hidden", .base_colour = vec3(1), .opacity = 0.5F});
    const oit::Scene scene = oit::scene_of(mesh, 0.25F);
    const std::vector<cl_float4> image = picture_of(scene);
    const dvec3 wall = colour_alone(0.5F, 0, mesh.materials[1]);
    const dvec3 glass = colour_alone(0.4F, 0.5F, mesh.materials[0]);
    CHECK(are_close(colour(image[middle]), 0.25 * glass + 0.75 * wall));
    // --alpha 1 covers all, but stores fragments as any other opacity.
    const oit::Scene covered = oit::scene_of(torus_knot(2, 3, 30, 6), 1);
    CHECK_FALSE(covered.is_opaque(covered.instances.front()));
}

TEST_CASE("colours and opacities of vertices are factors, as in double precision") {
    Mesh mesh = torus_knot(2, 3, 120, 12);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
        mesh.colours.emplace_back(0.5F + 0.5F * mesh.positions[i], i % 5 == 0 ? 0.25F : 0.75F);
    mesh.materials = {{.name = "fades", .base_colour = vec3(1, 0.5F, 1), .opacity = 0.5F},
                      {.name = "solid", .base_colour = {}, .opacity = {}}};
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        mesh.triangle_materials.push_back(t < mesh.triangles.size() / 2 ? 0 : 1);
    const std::size_t half = mesh.triangles.size() / 2;
    for (std::size_t t = half; t < mesh.triangles.size(); ++t)
        for (const std::uint32_t vertex : mesh.triangles[t])
            if (vertex > mesh.positions.size() / 2 + 12) mesh.colours[vertex].w = 1;
    for (const std::optional<float> own : {std::optional<float>{}, std::optional<float>{0.5F}}) {
        std::vector<oit::PlacedMesh> placed;
        placed.push_back({.mesh = mesh, .alpha = 0.3F, .own_alpha = own});
        oit::Scene scene = oit::scene_of(std::move(placed));
        oit::add_floor(scene);
        const oit::Frame frame{.scene = scene,
                               .views = {support::frame_unit_sphere({20, 15}, 160, 120)}};
        oit::Renderer renderer(device(), frame);
        CHECK(renderer.features().tints);
        CHECK(renderer.features().opacities == !own);
        renderer.draw();
        const oit::Comparison comparison =
            oit::compare(oit::draw_reference(frame), renderer.image(), renderer.method().depths());
        CHECK(comparison.fragments > 1000);
        CHECK(comparison.pixels_with_other_count == 0);
        CHECK(comparison.pixels_over == comparison.pixels_explained);
    }
}

TEST_CASE("materials that look the same are one model") {
    Mesh mesh;
    for (int i = 0; i < 6; ++i)
        add_square(mesh, 0.5F, 0.1F * static_cast<float>(i),
                   {.name = std::to_string(i),
                    .base_colour = vec3(i % 2 == 0 ? 0.2F : 0.8F),
                    .opacity = 0.5F});
    const oit::Scene scene = oit::scene_of(mesh, 0.3F);
    CHECK(scene.models.size() == 2);
    CHECK(scene.triangles() == 12);
}

// An OBJ file with a square around the z axis at a height.
std::string square_text(float half, float z) {
    std::string text;
    for (const auto& [x, y] : {std::pair(-half, -half), {half, -half}, {half, half}, {-half, half}})
        text += "v " + std::to_string(x) + " " + std::to_string(y) + " " + std::to_string(z) + "\n";
    return text + "f 1 2 3 4\n";
}

TEST_CASE("meshes of several files keep their places to one another, each with its opacity") {
    const Folder folder;
    const std::string wall = folder.write("wall.obj", square_text(30, -10)).string(),
                      pane = folder.write("pane:0.5.obj", square_text(20, 10)).string();
    oit::FrameOptions options;
    options.scene = wall + ":1";
    options.more_meshes = {pane + ":0.25", pane};
    const oit::Scene scene = oit::make_scene(options);
    REQUIRE(scene.meshes.size() == 3);
    CHECK(scene.meshes[0].alpha == 1);
    CHECK_FALSE(scene.meshes[2].alpha);
    CHECK(scene.meshes[2].file == pane);
    CHECK(scene.is_opaque(scene.instances[0]));
    CHECK(scene.material_of(scene.instances[1]).alpha == 0.25F);
    CHECK(scene.material_of(scene.instances[2]).alpha == options.alpha);
    const auto width_of = [&](std::size_t model) {
        const auto& positions = scene.models[model].mesh.positions;
        const auto [low, high] =
            std::ranges::minmax(positions, {}, [](const vec3& p) { return p.x; });
        return high.x - low.x;
    };
    const float scale = width_of(0) / 60;
    CHECK(std::abs(width_of(1) - 40 * scale) < 1e-5F);
    const float apart = scene.models[1].mesh.positions[0].z - scene.models[0].mesh.positions[0].z;
    CHECK(std::abs(apart - 20 * scale) < 1e-5F);
    CHECK(oit::title_of(options) == "wall.obj:1 + pane:0.5.obj:0.25 + pane:0.5.obj");
    for (const char* bad : {":2", ":nan", ":-0.1", ":0.5x", ":"})
        CHECK(contains(
            error_of<support::InputError>([&] { (void)oit::mesh_file(wall + bad); }).what(),
            "opacity from 0 to 1"));
}

TEST_CASE("scenes are drawn alone, and only meshes are turned") {
    const Folder folder;
    const std::string pane = folder.write("pane.obj", square_text(1, 0)).string();
    using Arguments = std::vector<std::string>;
    for (const auto& [arguments, named] :
         {std::pair<Arguments, std::string>{{"gearworks", pane}, "gearworks"},
          {{pane, "smoke"}, "smoke"},
          {{"smoke:0.5"}, "--alpha"},
          {{pane, "nosuch.obj:0.5"}, "nosuch.obj:0.5"},
          {{"smoke", "--up", "z"}, "--up"},
          {{pane, "--up", "w"}, "x, y or z"}}) {
        std::vector<const char*> pointers{"cellist-oit"};
        for (const std::string& argument : arguments) pointers.push_back(argument.c_str());
        const auto parse = [&] {
            (void)oit::parse_options(static_cast<int>(pointers.size()), pointers.data());
        };
        CHECK(contains(error_of<support::InputError>(parse).what(), named));
    }
}

TEST_CASE("the axis that points up is turned to y, without a mirror") {
    for (const auto& [axis, up, then] :
         {std::tuple{support::UpAxis::z, vec3(0, 0, 1), vec3(1, 0, 0)},
          {support::UpAxis::x, vec3(1, 0, 0), vec3(0, 1, 0)},
          {support::UpAxis::y, vec3(0, 1, 0), vec3(0, 0, 1)}}) {
        Mesh mesh;
        mesh.positions = {up, then, glm::cross(up, then)};
        mesh.normals = mesh.positions;
        support::turn_up(mesh, axis);
        CHECK(mesh.positions[0] == vec3(0, 1, 0));
        CHECK(glm::cross(mesh.positions[0], mesh.positions[1]) == mesh.positions[2]);
        CHECK(mesh.normals == mesh.positions);
    }
}

TEST_CASE("a floor is drawn from above only, with a shadow of the size of what stands on it") {
    oit::FrameOptions options;
    options.opaque_floor = true;
    for (const double elevation : {-30.0, 20.0}) {
        options.orbit.elevation_degrees = elevation;
        oit::Scene scene = oit::scene_of(torus_knot(2, 3, 60, 8), 0.35F);
        oit::stand_on_floor(scene, options);
        CHECK(scene.instances.size() == (elevation > 0 ? 2U : 1U));
    }
    for (const float width : {0.2F, 0.9F}) {
        Mesh mesh;
        add_square(mesh, width, 0.3F, {});
        oit::Scene scene = oit::scene_of(mesh, 0.35F);
        oit::add_floor(scene);
        CHECK(std::abs(scene.lighting.floor_shadow_radius[0] - 1.25F * width) < 1e-5F);
        CHECK(std::abs(scene.lighting.floor_shadow_centre[1] - 0.3F) < 1e-5F);
    }
}

}  // namespace
}  // namespace cellist::test
