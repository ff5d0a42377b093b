// SPDX-License-Identifier: MIT
#include "frame.hpp"

#include <algorithm>

#include <glm/geometric.hpp>

#include "input_error.hpp"
#include "motion_kernels.hpp"
#include "view.hpp"

namespace motion {
namespace {

cl_float4 float4(const glm::dvec3& v, double w) {
    return {{static_cast<cl_float>(v.x), static_cast<cl_float>(v.y), static_cast<cl_float>(v.z),
             static_cast<cl_float>(w)}};
}

Shading shading_of(const Scene& scene, const Settings& settings) {
    const support::Light& light = scene.light;
    const glm::dvec3 axis = glm::normalize(light.target - light.position);
    Shading shading{};
    shading.light = light.is_spot ? float4(light.position, 1) : float4(-axis, 0);
    shading.eye = float4(scene.eye, 1);
    shading.intensity = float4(glm::dvec3(light.intensity), 0);
    shading.ambient = float4(glm::dvec3(0.06), 0);
    shading.background = float4(glm::dvec3(0.02), 0);
    shading.bias = settings.bias;
    return shading;
}

}  // namespace

Frame::Frame(const cellist::Device& its_device, const Scene& its_scene, const Settings& s)
    : device(its_device),
      settings(s),
      scene(device, its_scene),
      camera(
          device, its_scene,
          camera_view(its_scene.eye, its_scene.target, its_scene.field_degrees, s.width, s.height)),
      light(device, its_scene, light_view(its_scene.light, s.shadow_map), s.insides),
      shading(shading_of(its_scene, s)),
      keys(device, pixels() * std::clamp<std::size_t>(s.samples, 1, batch_samples)),
      receivers(device, pixels() * std::clamp<std::size_t>(s.samples, 1, batch_samples)),
      farthest(device,
               static_cast<std::size_t>(s.shadow_map) * static_cast<std::size_t>(s.shadow_map)),
      project_vertices(moving_kernel(device, kernels::project_cl, "project_vertices")) {}

void Frame::project() {
    for (const SeenScene* seen : {&camera, &light})
        project_vertices.run(cellist::Range::padded(scene.vertex_count, 64), seen->view,
                             scene.begin, scene.end, scene.vertex_count, seen->vertices);
}

std::size_t Frame::pixels() const {
    return static_cast<std::size_t>(settings.width) * static_cast<std::size_t>(settings.height);
}

cellist::Storage Frame::storage() const {
    // Processors test contiguous lists faster.
    return settings.storage.value_or(device.info().one_thread_per_work_group
                                         ? cellist::Storage::counted
                                         : cellist::Storage::linked);
}

std::string with_receivers(std::string_view text) {
    return std::string(kernels::keys_clh) + std::string(kernels::receiver_clh) + std::string(text);
}

std::string ShadowTest::text_of(std::string_view pass) {
    return with_receivers(std::string(pass) + std::string(kernels::test_clh));
}

}  // namespace motion
