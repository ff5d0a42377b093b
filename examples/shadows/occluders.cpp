#include "occluders.hpp"

#include <algorithm>
#include <utility>

#ifdef SHADOWS_HAVE_EMBREE
#include <embree3/rtcore.h>
#endif

#include "grid/exact.hpp"
#include "input_error.hpp"

namespace shadows {

#ifdef SHADOWS_HAVE_EMBREE

struct Occluders::Tree {
    RTCDevice device = rtcNewDevice(nullptr);
    RTCScene scene = rtcNewScene(device);

    explicit Tree(const std::vector<grid::GridTriangle>& triangles) {
        rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
        RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
        // Embree keeps the number of vertices in 32 bits.
        auto* const corners = static_cast<glm::vec3*>(
            rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                    sizeof(glm::vec3), 3 * triangles.size()));
        auto* const indices = static_cast<unsigned*>(
            rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                    3 * sizeof(unsigned), triangles.size()));
        for (std::size_t i = 0; i < triangles.size(); ++i) {
            corners[3 * i] = triangles[i].a;
            corners[3 * i + 1] = triangles[i].b;
            corners[3 * i + 2] = triangles[i].c;
        }
        for (std::size_t i = 0; i < 3 * triangles.size(); ++i)
            indices[i] = static_cast<unsigned>(i);
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene, geometry);
        rtcReleaseGeometry(geometry);
        rtcCommitScene(scene);
        if (rtcGetDeviceError(device) != RTC_ERROR_NONE)
            throw support::InputError("Embree cannot hold the triangles");
    }
    ~Tree() {
        rtcReleaseScene(scene);
        rtcReleaseDevice(device);
    }
    Tree(const Tree&) = delete;
    Tree& operator=(const Tree&) = delete;
};

Occluders::Occluders(std::vector<grid::GridTriangle> triangles)
    : triangles_(std::move(triangles)), tree_(std::make_unique<Tree>(triangles_)) {}

std::string Occluders::name() { return "Embree " RTC_VERSION_STRING; }

double Occluders::cost() const { return 50; }

bool Occluders::block(const glm::vec3& from, const glm::vec3& to) const {
    const glm::vec3 along = to - from;
    RTCRay ray{};
    ray.org_x = from.x;
    ray.org_y = from.y;
    ray.org_z = from.z;
    ray.dir_x = along.x;
    ray.dir_y = along.y;
    ray.dir_z = along.z;
    ray.tfar = 1;
    ray.mask = ~0U;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(tree_->scene, &context, &ray);
    return ray.tfar < 0;
}

#else

struct Occluders::Tree {};

Occluders::Occluders(std::vector<grid::GridTriangle> triangles)
    : triangles_(std::move(triangles)) {}

std::string Occluders::name() { return "every triangle"; }

double Occluders::cost() const {
    return static_cast<double>(std::max<std::size_t>(1, triangles_.size()));
}

bool Occluders::block(const glm::vec3& from, const glm::vec3& to) const {
    return block_exactly(from, to);
}

#endif

Occluders::~Occluders() = default;

bool Occluders::block_exactly(const glm::vec3& from, const glm::vec3& to) const {
    return grid::meets_any(from, to, triangles_);
}

}  // namespace shadows
