#pragma once

#include <vector>

#include <glm/mat4x4.hpp>

#include "look.hpp"
#include "material.hpp"
#include "mesh.hpp"

namespace oit {

/// A mesh, and how opaque it is at each vertex where that is not the same everywhere.
struct Model {
    support::Mesh mesh;
    std::vector<float> opacities = {};  ///< a factor for each vertex, 0 to 1, or none
};

/// A model at a place, turning about its own z axis. Places do not mirror.
struct Instance {
    std::size_t model = 0;
    std::size_t material = 0;
    glm::dmat4 place{1.0};  ///< from the model to the world
    double turns_per_second = 0;
};

/// What there is to draw: inside of the unit sphere, but for the floor. Instances of opaque materials
/// hide what lies behind them.
struct Scene {
    std::vector<Model> models = {};
    std::vector<Material> materials = {};
    std::vector<Instance> instances = {};
    Look look = studio_look(-1);

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
[[nodiscard]] glm::dmat4 place_at(const Instance& instance, double time);

/// The surface of the example's pictures.
[[nodiscard]] Material glass(float alpha);

/// Adds an opaque floor of two large triangles at look.floor_height.
void add_floor(Scene& scene);

/// A mesh of `glass(alpha)`; the floor, if it is added, cuts a little into its underside.
[[nodiscard]] Scene scene_of(support::Mesh mesh, float alpha);

}  // namespace oit
