#include "embree.hpp"

#include <string>

#include <cellist/error.hpp>

#ifdef TRIANGLE_GRID_EMBREE

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <memory>
#include <numeric>
#include <thread>

#include <embree3/rtcore.h>

#include "stopwatch.hpp"

namespace triangle_grid {
namespace {

using EmbreeDevice =
    std::unique_ptr<RTCDeviceTy, decltype([](RTCDevice device) { rtcReleaseDevice(device); })>;
using EmbreeScene =
    std::unique_ptr<RTCSceneTy, decltype([](RTCScene scene) { rtcReleaseScene(scene); })>;

void require_no_error(const EmbreeDevice& device) {
    const RTCError error = rtcGetDeviceError(device.get());
    if (error != RTC_ERROR_NONE)
        throw cellist::Error("Embree fails with error " + std::to_string(error));
}

// A scene of one geometry. The buffers are shared, and must outlive the scene.
EmbreeScene make_scene(const EmbreeDevice& device, std::span<const glm::vec3> corners,
                       std::span<const std::uint32_t> indices) {
    EmbreeScene scene(rtcNewScene(device.get()));
    rtcSetSceneFlags(scene.get(),
                     static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_DYNAMIC));
    // The quality for scenes that are rebuilt for each frame.
    rtcSetSceneBuildQuality(scene.get(), RTC_BUILD_QUALITY_LOW);
    const RTCGeometry geometry = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_LOW);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                               corners.data(), 0, sizeof(glm::vec3), corners.size());
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, indices.data(),
                               0, 3 * sizeof(std::uint32_t), indices.size() / 3);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene.get(), geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene.get());
    return scene;
}

bool is_occluded(RTCScene scene, const Segment& segment) {
    const glm::vec3 direction = segment.to - segment.from;
    RTCRay ray{};
    ray.org_x = segment.from.x;
    ray.org_y = segment.from.y;
    ray.org_z = segment.from.z;
    ray.dir_x = direction.x;
    ray.dir_y = direction.y;
    ray.dir_z = direction.z;
    ray.tfar = 1;
    ray.mask = 0xFFFFFFFF;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(scene, &context, &ray);
    return ray.tfar < 0;
}

}  // namespace

bool has_embree() { return true; }

EmbreeAnswers ask_embree(std::span<const grid::GridTriangle> triangles,
                         std::span<const Segment> segments) {
    std::vector<glm::vec3> corners;
    corners.reserve(3 * triangles.size() + 1);
    for (const grid::GridTriangle& triangle : triangles)
        corners.insert(corners.end(), {triangle.a, triangle.b, triangle.c});
    std::vector<std::uint32_t> indices(corners.size());
    std::iota(indices.begin(), indices.end(), 0U);
    corners.emplace_back(0);  // Embree reads 16 bytes of each

    const EmbreeDevice device(rtcNewDevice(nullptr));
    if (!device) throw cellist::Error("Embree has no device");
    const EmbreeScene scene = make_scene(device, corners, indices);
    require_no_error(device);
    const support::Stopwatch build;
    const RTCGeometry geometry = rtcGetGeometry(scene.get(), 0);
    rtcUpdateGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0);
    rtcCommitGeometry(geometry);
    rtcCommitScene(scene.get());
    EmbreeAnswers answers{std::vector<std::uint8_t>(segments.size()), build.ms(), 0};
    require_no_error(device);

    constexpr std::size_t at_once = 4096;
    std::atomic<std::size_t> next{0};
    const auto work = [&] {
        for (;;) {
            const std::size_t begin = next.fetch_add(at_once);
            if (begin >= segments.size()) return;
            const std::size_t end = std::min(begin + at_once, segments.size());
            for (std::size_t i = begin; i < end; ++i)
                answers.hits[i] = is_occluded(scene.get(), segments[i]) ? 1 : 0;
        }
    };
    const support::Stopwatch trace;
    {
        std::vector<std::jthread> threads;
        for (unsigned i = 1; i < std::thread::hardware_concurrency(); ++i)
            threads.emplace_back(work);
        work();
    }
    answers.trace_ms = trace.ms();
    return answers;
}

}  // namespace triangle_grid

#else

namespace triangle_grid {

bool has_embree() { return false; }

EmbreeAnswers ask_embree(std::span<const grid::GridTriangle>, std::span<const Segment>) {
    throw cellist::Error("this build has no Embree");
}

}  // namespace triangle_grid

#endif
