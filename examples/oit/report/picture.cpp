#include "report/picture.hpp"

#include <cstddef>

namespace oit {

std::vector<cl_float4> side_by_side(const std::vector<cl_float4>& image, const Frame& frame) {
    const auto width = static_cast<std::size_t>(frame.width());
    const auto height = static_cast<std::size_t>(frame.height());
    std::vector<cl_float4> rows;
    rows.reserve(image.size());
    for (std::size_t y = 0; y < height; ++y)
        for (std::size_t eye = 0; eye < frame.views.size(); ++eye) {
            const auto row =
                image.begin() + static_cast<std::ptrdiff_t>((eye * height + y) * width);
            rows.insert(rows.end(), row, row + static_cast<std::ptrdiff_t>(width));
        }
    return rows;
}

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

}  // namespace oit
