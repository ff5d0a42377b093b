// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "mesh.hpp"
#include "scene/lighting.hpp"
#include "scene/material.hpp"

namespace oit {

/// A mesh, and how its vertices change the material where that is not the same everywhere.
struct Model {
    support::Mesh mesh;
    std::vector<float> opacities = {};  ///< a factor for each vertex, 0 to 1, or none
    std::vector<glm::vec3> tints = {};  ///< factors of the tints for each vertex, 0 to 1, or none
};

/// A file that a scene was made from.
struct SceneMesh {
    std::string file;
    std::optional<float> alpha;  ///< of all surfaces of the file; else the file's own, or --alpha
    std::uint64_t triangles = 0;
    std::uint64_t ignored_textures = 0;
    bool ends_within_line = false;
    support::MeshDrops drops = {};
    std::vector<std::string> notes = {};  ///< of the reader
};

/// A placed model that turns about its own z axis. `to_world` does not mirror.
struct Instance {
    std::size_t model = 0;
    std::size_t material = 0;
    glm::dmat4 to_world{1.0};
    double turns_per_second = 0;
};

/// What there is to draw: inside of the unit sphere, but for the floor. Instances of opaque
/// materials hide what lies behind them.
struct Scene {
    std::vector<Model> models = {};
    std::vector<Material> materials = {};
    std::vector<Instance> instances = {};
    std::vector<SceneMesh> meshes = {};  ///< none where the scene is computed
    Lighting lighting = studio_lighting(-1);

    [[nodiscard]] const Material& material_of(const Instance& instance) const {
        return materials.at(instance.material);
    }
    [[nodiscard]] bool is_opaque(const Instance& instance) const {
        return material_of(instance).blend == static_cast<cl_uint>(Blend::opaque);
    }
    /// Triangles of all instances.
    [[nodiscard]] std::uint64_t triangles() const;
};

/// Where an instance is at a time in seconds.
[[nodiscard]] glm::dmat4 transform_at(const Instance& instance, double time);

/// The surface of the example's pictures.
[[nodiscard]] Material glass(float alpha);

/// Adds an opaque floor of two large triangles at lighting.floor_height. Its shadow takes the size
/// of what stands on it.
void add_floor(Scene& scene);

/// A mesh with the materials that its file gives, and `glass(alpha)` for what the file does not
/// say. Surfaces that the file says are opaque hide what lies behind them. The floor, if it is
/// added, cuts a little into the underside.
[[nodiscard]] Scene scene_of(support::Mesh mesh, float alpha);

/// Meshes of several files in one picture, in their common coordinates.
struct PlacedMesh {
    support::Mesh mesh;
    float alpha = 1;                      ///< where the file does not say
    std::optional<float> own_alpha = {};  ///< whatever the file says; 1 makes opaque surfaces
};
[[nodiscard]] Scene scene_of(std::vector<PlacedMesh> meshes);

}  // namespace oit
