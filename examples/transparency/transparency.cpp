// SPDX-License-Identifier: MIT
#include "transparency.hpp"

#include <cstddef>

#include "raster/rasteriser.hpp"
#include "transparency_kernels.hpp"

namespace transparency {

Picture draw(const cellist::Device& device, const support::Mesh& mesh, const raster::View& view,
             const Surface& surface) {
    const auto width = static_cast<std::size_t>(view.width);
    const auto height = static_cast<std::size_t>(view.height);

    // A list for each pixel. The pool grows to what the scene needs.
    cellist::Lists<Fragment> fragments(device, {width, height});

    // The mesh on the device, one instance of it, and one view.
    const support::Mesh* const meshes[] = {&mesh};
    const raster::Placed instances[] = {{.mesh = 0}};
    const raster::View views[] = {view};
    const std::size_t drawn[] = {0};
    raster::SetupKernels setup(device);
    const raster::Geometry geometry(device, meshes);
    raster::Projection projection(device, setup, geometry, instances, views);
    raster::Triangles triangles(device, projection, drawn);

    // The kernels of this example.
    raster::Pass insert(device, {}, kernels::insert_cl, "insert.cl", fragments,
                        cellist::type<Surface>);
    cellist::Kernel blend(device, {.text = std::string(kernels::blend_cl), .file_name = "blend.cl"},
                          "blend", fragments, cellist::type<Surface>);
    cellist::Buffer<cl_float4> image(device, width * height);

    // Transform, rasterise and insert. finish_or_grow() is false if the rasteriser's queues were
    // too short; they have grown then.
    projection.transform();
    do {
        triangles.bin();
        fragments.build([&] { triangles.draw(insert, fragments, geometry.normals(), surface); });
    } while (!triangles.finish_or_grow());

    // Sort the fragments of each pixel, nearest first, and blend them.
    fragments.sort(&Fragment::depth);
    blend.run({width, height}, fragments, surface, image);

    return {image.download(), fragments.lengths()};
}

}  // namespace transparency
