// SPDX-License-Identifier: MIT
#include "grid/embree.hpp"

#include <cellist/error.hpp>

#ifdef GRID_EMBREE

#include <cstdint>
#include <numeric>
#include <vector>

#include <embree3/rtcore.h>

namespace grid {

struct EmbreeTriangles::Tree {
    using Device =
        std::unique_ptr<RTCDeviceTy, decltype([](RTCDevice device) { rtcReleaseDevice(device); })>;
    using Scene =
        std::unique_ptr<RTCSceneTy, decltype([](RTCScene scene) { rtcReleaseScene(scene); })>;

    std::vector<glm::vec3> corners;
    std::vector<std::uint32_t> indices;
    Device device{rtcNewDevice(nullptr)};
    Scene scene;

    explicit Tree(std::span<const GridTriangle> triangles) {
        if (!device) throw cellist::Error("Embree has no device");
        corners.reserve(3 * triangles.size() + 1);
        for (const GridTriangle& triangle : triangles)
            corners.insert(corners.end(), {triangle.a, triangle.b, triangle.c});
        indices.resize(corners.size());
        std::iota(indices.begin(), indices.end(), 0U);
        corners.emplace_back(0);  // Embree reads 16 bytes of each

        scene.reset(rtcNewScene(device.get()));
        rtcSetSceneFlags(scene.get(), static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_ROBUST |
                                                                 RTC_SCENE_FLAG_DYNAMIC));
        // The quality for scenes that are rebuilt for each frame.
        rtcSetSceneBuildQuality(scene.get(), RTC_BUILD_QUALITY_LOW);
        const RTCGeometry geometry = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
        rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_LOW);
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                   corners.data(), 0, sizeof(glm::vec3), corners.size());
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                   indices.data(), 0, 3 * sizeof(std::uint32_t),
                                   indices.size() / 3);
        rtcAttachGeometry(scene.get(), geometry);
        rtcReleaseGeometry(geometry);
        build();
    }

    void build() {
        const RTCGeometry geometry = rtcGetGeometry(scene.get(), 0);
        rtcUpdateGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0);
        rtcCommitGeometry(geometry);
        rtcCommitScene(scene.get());
        const RTCError error = rtcGetDeviceError(device.get());
        if (error != RTC_ERROR_NONE)
            throw cellist::Error("Embree fails with error " + std::to_string(error));
    }
};

bool has_embree() { return true; }

EmbreeTriangles::EmbreeTriangles(std::span<const GridTriangle> triangles)
    : tree_(std::make_unique<Tree>(triangles)) {}

std::string EmbreeTriangles::name() { return "Embree " RTC_VERSION_STRING; }

void EmbreeTriangles::rebuild() { tree_->build(); }

bool EmbreeTriangles::meets_any(const glm::vec3& from, const glm::vec3& to) const {
    const glm::vec3 direction = to - from;
    RTCRay ray{};
    ray.org_x = from.x;
    ray.org_y = from.y;
    ray.org_z = from.z;
    ray.dir_x = direction.x;
    ray.dir_y = direction.y;
    ray.dir_z = direction.z;
    ray.tfar = 1;
    ray.mask = 0xFFFFFFFF;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(tree_->scene.get(), &context, &ray);
    return ray.tfar < 0;
}

}  // namespace grid

#else

namespace grid {

struct EmbreeTriangles::Tree {};

bool has_embree() { return false; }

EmbreeTriangles::EmbreeTriangles(std::span<const GridTriangle>) {
    throw cellist::Error("this build has no Embree");
}

std::string EmbreeTriangles::name() { return "no Embree"; }

void EmbreeTriangles::rebuild() {}

bool EmbreeTriangles::meets_any(const glm::vec3&, const glm::vec3&) const { return false; }

}  // namespace grid

#endif

grid::EmbreeTriangles::~EmbreeTriangles() = default;
