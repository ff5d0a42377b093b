// SPDX-License-Identifier: MIT
// GLM's vectors and matrices are members of records, packed as on the host.
#include <cellist/glm.hpp>

#include "support/inserts.hpp"
#include "support/skip.hpp"

namespace cellist::test {
namespace {

struct Camera {
    glm::mat4 view;
    glm::mat3 normal;
    glm::mat2 scale;
    glm::vec3 eye;
    cl_float fov;
};
CELLIST_STRUCT(Camera, view, normal, scale, eye, fov);

struct Sample {
    glm::vec3 position;
    glm::vec2 uv;
    glm::vec4 colour;
    glm::ivec3 cell;
    glm::uvec2 ids;
};
CELLIST_STRUCT(Sample, position, uv, colour, cell, ids);
static_assert(sizeof(Sample) == 56);

constexpr auto glm_kernels_source = R"(
#include <cellist/lists.clh>
#include <cellist/glm.clh>

kernel void samples(CELLIST_LISTS(Sample, lists), const Camera camera)
{
    const uint i = get_global_id(0);
    Sample sample;
    sample.position = camera.eye;
    sample.position.x += i;
    const float3 p = cellist_float3(sample.position);
    sample.uv.x = p.x + p.y + p.z, sample.uv.y = camera.fov;
    sample.colour = camera.view.columns[i % 4];
    sample.cell.x = -(int)i, sample.cell.y = camera.normal.columns[2].y, sample.cell.z = 3;
    sample.ids.x = camera.scale.columns[1].x, sample.ids.y = i;
    cellist_insert(lists, i % 7, sample);
}
)";

TEST_CASE("GLM types are read and written by kernels") {
    Camera camera{};
    for (int column = 0; column < 4; ++column)
        camera.view[column] = glm::vec4(column, column + 10, column + 20, column + 30);
    camera.normal[2] = glm::vec3(1, 77, 3);
    camera.scale[1] = glm::vec2(55, 1);
    camera.eye = glm::vec3(0.5f, 2, 4);
    camera.fov = 0.75f;

    Inserts<Sample> expected;
    for (cl_uint i = 0; i < 144; ++i) {
        const auto x = static_cast<float>(i);
        expected.add(i % 7, {camera.eye + glm::vec3(x, 0, 0), glm::vec2(x + 6.5f, 0.75f),
                             camera.view[static_cast<int>(i % 4)],
                             glm::ivec3(-static_cast<int>(i), 77, 3), glm::uvec2(55, i)});
    }
    Lists<Sample> lists(device(), {7});
    Kernel kernel(device(), glm_kernels_source, "samples", lists, type<Camera>);
    require_complete(lists.build(kernel, 144, camera), 144);
    require_same(lists.download(), oracle_of(expected, 7));

    lists.sort_by("-record.position.x");
    const HostLists<Sample> host = lists.download();
    require_same(host, oracle_of(expected, 7));
    for (std::uint64_t cell = 0; cell < 7; ++cell)
        REQUIRE(std::ranges::is_sorted(host.cell(cell), std::ranges::greater{},
                                       [](const Sample& sample) { return sample.position.x; }));
}

struct DoubleSample {
    glm::dvec3 position;
    glm::dmat2 scale;
};
CELLIST_STRUCT(DoubleSample, position, scale);

TEST_CASE("GLM's double vectors are known, where the device has doubles") {
    if (!device().info().fp64) CELLIST_SKIP("the device has no doubles");
    Kernel kernel(device(), R"(
kernel void scale(global DoubleSample* samples)
{
    samples[0].position.z *= samples[0].scale.columns[1].y;
}
)",
                  "scale", type<DoubleSample>);
    DoubleSample sample{glm::dvec3(1, 2, 3), glm::dmat2(0)};
    sample.scale[1][1] = 0x1p300;
    const Buffer<DoubleSample> samples(device(), std::vector{sample});
    kernel.run(1, samples);
    REQUIRE(samples.download()[0].position == glm::dvec3(1, 2, 3 * 0x1p300));
}

}  // namespace
}  // namespace cellist::test
