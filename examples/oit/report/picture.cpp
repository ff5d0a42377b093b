// SPDX-License-Identifier: MIT
#include "report/picture.hpp"

#include "heat_map.hpp"

namespace oit {

std::vector<cl_float4> linear_image(const Reference& reference) {
    std::vector<cl_float4> image;
    image.reserve(reference.image.size());
    for (const glm::dvec3& colour : reference.image)
        image.push_back({{static_cast<float>(colour.x), static_cast<float>(colour.y),
                          static_cast<float>(colour.z), 1.0F}});
    return image;
}

int picture_width(const Frame& frame) {
    return frame.width() * static_cast<int>(frame.views.size());
}

void write_layers(const std::filesystem::path& path, const std::vector<cl_uint>& layers,
                  const Frame& frame) {
    const std::vector<cl_uint> rows = side_by_side(layers, frame);
    support::write_heat_map(path, {.values = std::vector<double>(rows.begin(), rows.end()),
                                   .width = picture_width(frame),
                                   .height = frame.height(),
                                   .caption = "layers"});
}

}  // namespace oit
