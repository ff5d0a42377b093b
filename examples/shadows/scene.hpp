// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "light.hpp"
#include "mesh.hpp"

namespace shadows {

/// A mesh at a place in the world.
struct Instance {
    std::size_t mesh = 0;
    glm::dmat4 to_world{1.0};
    glm::vec3 albedo{0.75F};  ///< linear RGB
    bool blocks = false;      ///< indirect light
};

/// Parallel light that falls into the room of these scenes through its open front.
[[nodiscard]] support::Light make_parallel_light();

/// What is drawn, in metres. A scene fits into a box of about 3 m.
struct Scene {
    std::vector<support::Mesh> meshes;
    std::vector<Instance> instances;
    support::Light light;
    glm::dvec3 eye{0, 0, 3.5};
    glm::dvec3 target{0};
    double field_degrees = 40;
    /// The box that moving blockers stay in.
    glm::dvec3 low{0}, high{0};
    /// Moves instances, light or camera to where they are after so many seconds; may be empty.
    std::function<void(Scene&, double seconds)> move;
};

[[nodiscard]] std::size_t triangle_count(const Scene& scene);

/// A room like that of Yang et al., Figure 7: a spot light shines on a wall, and bars stand between
/// the wall and a sphere that only the wall lights.
[[nodiscard]] Scene make_room();

/// The same room with rings of `triangles` triangles together that fly through it.
[[nodiscard]] Scene make_swarm(std::size_t triangles);

/// The same room with this mesh in it, in place of the bars and the sphere.
[[nodiscard]] Scene make_mesh_room(support::Mesh mesh);

/// Merges the vertices of each cube of `cells` along the longest side of the mesh: a coarser mesh
/// (Rossignac, Borrel: "Multi-resolution 3D Approximations for Rendering Complex Scenes", 1993).
[[nodiscard]] support::Mesh simplify(const support::Mesh& mesh, int cells);

}  // namespace shadows
