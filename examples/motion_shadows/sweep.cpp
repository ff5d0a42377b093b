// SPDX-License-Identifier: MIT
#include "sweep.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "input_error.hpp"
#include "motion_kernels.hpp"
#include "sides.hpp"

namespace motion {
namespace {

// Triangles that sweep over many pixels are divided while there is room for these tiles.
constexpr std::size_t tiles_max = 1 << 20;

// Receivers keep the highest bit of a triangle's number for RECEIVER_BLOCKED.
constexpr std::size_t triangles_max = 0x7FFFFFFE;

std::vector<cl_float> floats_of(const std::vector<glm::vec3>& points) {
    std::vector<cl_float> floats;
    floats.reserve(3 * points.size());
    for (const glm::vec3& p : points) floats.insert(floats.end(), {p.x, p.y, p.z});
    return floats;
}

std::vector<cl_uint> indices_of(const Scene& scene) {
    if (scene.begin.size() != scene.end.size() || scene.colours.size() != scene.triangles.size())
        throw support::InputError(
            "a moving scene needs both positions of each vertex, and a "
            "colour of each triangle");
    if (scene.triangles.size() > triangles_max)
        throw support::InputError("a moving scene of " + std::to_string(scene.triangles.size()) +
                                  " triangles: expected at most " + std::to_string(triangles_max));
    std::vector<cl_uint> indices;
    indices.reserve(3 * scene.triangles.size());
    for (const glm::uvec3& t : scene.triangles) {
        if (std::max({t.x, t.y, t.z}) >= scene.begin.size())
            throw support::InputError(
                "a triangle of a moving scene has a vertex that does not "
                "exist");
        indices.insert(indices.end(), {t.x, t.y, t.z});
    }
    return indices;
}

cl_float linear_of_srgb(unsigned value) {
    const double c = value / 255.0;
    return static_cast<cl_float>(c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4));
}

std::vector<cl_float4> albedos_of(const Scene& scene) {
    std::vector<cl_float4> albedos;
    albedos.reserve(scene.colours.size());
    for (const glm::u8vec4& c : scene.colours)
        albedos.push_back({{linear_of_srgb(c.x), linear_of_srgb(c.y), linear_of_srgb(c.z), 1}});
    return albedos;
}

cellist::Range whole_device(const cellist::DeviceInfo& device) {
    const std::size_t group = device.one_thread_per_work_group ? 1 : 64;
    const std::size_t groups =
        std::size_t{device.compute_units} * (device.one_thread_per_work_group ? 16 : 32);
    return cellist::Range::padded(groups * group, group);
}

}  // namespace

std::string with_moving(std::string_view text) {
    return "#include <cellist/lists.clh>\n" + std::string(kernels::moving_clh) + std::string(text);
}

std::string Sweep::text_of(const cellist::Device& device, std::string_view pass) {
    const char* definitions = device.info().one_thread_per_work_group
                                  ? "#define SWEEP_PIXELS_ALONE 4096\n"
                                  : "#define SWEEP_GROUP 64\n#define SWEEP_PIXELS_ALONE 64\n";
    return definitions + std::string(kernels::exact_clh) + std::string(kernels::keys_clh) +
           std::string(pass) + std::string(kernels::sweep_clh);
}

SceneBuffers::SceneBuffers(const cellist::Device& device, const Scene& scene)
    : vertex_count(static_cast<cl_uint>(scene.begin.size())),
      triangle_count(static_cast<cl_uint>(scene.triangles.size())),
      begin(device, floats_of(scene.begin)),
      end(device, floats_of(scene.end)),
      indices(device, indices_of(scene)),
      albedos(device, albedos_of(scene)),
      tiles(device, tiles_max),
      tile_count(device, 1),
      tiles_range(whole_device(device.info())) {}

SeenScene::SeenScene(const cellist::Device& device, const Scene& scene, const View& its_view,
                     bool insides)
    : view(its_view),
      vertices(device, scene.begin.size()),
      sides(device, insides ? std::vector<cl_uchar>(scene.triangles.size(), both_sides)
                            : seen_sides(scene, its_view)) {}

}  // namespace motion
