// SPDX-License-Identifier: MIT
#include "picture.hpp"

#include <algorithm>
#include <vector>

#include "camera.hpp"
#include "image.hpp"
#include "stopwatch.hpp"
#include "triangle_grid_kernels.hpp"

namespace triangle_grid {
namespace {

struct Camera {
    cl_float eye[3];
    cl_float ray_origin[3];
    cl_float ray_x[3];
    cl_float ray_y[3];
    cl_float sun[3];  ///< towards it
    cl_float floor;   ///< height
    cl_int width, height, samples;
};
CELLIST_STRUCT(Camera, eye, ray_origin, ray_x, ray_y, sun, floor, width, height, samples);

Camera make_camera(const support::Mesh& mesh, const PictureOptions& options) {
    const raster::View view = support::frame_unit_sphere(
        {.azimuth_degrees = 25, .elevation_degrees = 18}, options.width, options.height);
    Camera camera{};
    std::copy_n(view.eye, 3, camera.eye);
    std::copy_n(view.ray_origin, 3, camera.ray_origin);
    std::copy_n(view.ray_x, 3, camera.ray_x);
    std::copy_n(view.ray_y, 3, camera.ray_y);
    camera.sun[0] = -0.45F;
    camera.sun[1] = 0.8F;
    camera.sun[2] = 0.55F;
    camera.floor = 1;
    for (const glm::vec3& position : mesh.positions)
        camera.floor = std::min(camera.floor, position.y);
    camera.width = options.width;
    camera.height = options.height;
    camera.samples = options.samples;
    return camera;
}

std::vector<cl_float4> corner_normals(const support::Mesh& mesh) {
    std::vector<cl_float4> normals;
    normals.reserve(3 * mesh.triangles.size());
    for (const auto& triangle : mesh.triangles)
        for (const std::uint32_t corner : triangle) {
            const glm::vec3& normal = mesh.normals[corner];
            normals.push_back({{normal.x, normal.y, normal.z, 0}});
        }
    return normals;
}

}  // namespace

double draw_picture(const cellist::Device& device, const grid::TriangleGrid& triangles,
                    const support::Mesh& mesh, const PictureOptions& options) {
    const Camera camera = make_camera(mesh, options);
    const cellist::Buffer<cl_float4> normals(device, corner_normals(mesh));
    const auto pixels =
        static_cast<std::size_t>(options.width) * static_cast<std::size_t>(options.height);
    cellist::Buffer<cl_float4> image(device, pixels);
    cellist::Kernel draw(
        device,
        cellist::Source{.text = grid::with_queries(kernels::picture_cl), .file_name = "picture.cl"},
        "draw", triangles.entries(), cellist::type<grid::GridCells>,
        cellist::type<grid::GridTriangle>, cellist::type<Camera>);
    cellist::Range range((options.width + 7) / 8 * 8, (options.height + 7) / 8 * 8);
    range.local = {8, 8, 1};
    const double ms =
        support::measure_ms(device, [&] { triangles.run(draw, range, normals, camera, image); });
    support::write_image(options.out, image.download(), options.width, options.height);
    return ms;
}

}  // namespace triangle_grid
