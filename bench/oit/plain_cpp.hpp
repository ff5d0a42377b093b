// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "frame/frame.hpp"

namespace bench {

/// Draws a frame in plain C++ on one thread, in float, as one would write it without a device. Edge
/// functions scan the triangles. Opaque triangles use a depth buffer. Each pixel has a std::vector
/// of its transparent fragments. std::sort orders them by depth before they are blended. Vectors
/// keep their memory from frame to frame.
class PlainCpp {
public:
    /// Refers to the frame, which must outlive it. Supports what meshes and `gearworks` need: one
    /// eye, one sample, and covering or opaque surfaces in front of the near plane. Throws
    /// std::invalid_argument for other frames.
    explicit PlainCpp(const oit::Frame& frame);

    /// Draws once. Returns the milliseconds from the vertices to the image.
    double draw();

    /// The linear image, row by row from the top.
    [[nodiscard]] std::span<const cl_float4> image() const { return image_; }

private:
    // A vertex on the screen, in sub-pixels.
    struct Vertex {
        std::int32_t x, y;
        float inverse_depth;
        glm::vec3 normal;
    };
    struct Fragment {
        float depth;
        glm::vec3 colour;  // premultiplied
        float alpha;
    };
    static constexpr float far = std::numeric_limits<float>::infinity();
    struct Opaque {
        float depth = far;
        glm::vec3 colour{0.0F};
    };

    void draw_surfaces(bool opaque);
    void project(const support::Mesh& mesh, const raster::RasterInstance& instance);
    template <class Emit>
    void scan(const Vertex& a, const Vertex& b, const Vertex& c, const Emit& emit) const;
    void blend();

    const oit::Frame& frame_;
    int width_, height_;
    std::vector<Vertex> vertices_;  // of the instance that is drawn
    std::vector<Opaque> opaque_;    // of each pixel, where the frame has opaque surfaces
    std::vector<std::vector<Fragment>> lists_;
    std::vector<cl_float4> image_;
};

}  // namespace bench
