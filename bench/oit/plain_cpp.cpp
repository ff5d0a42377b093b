// SPDX-License-Identifier: MIT
#include "oit/plain_cpp.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "raster/rasteriser.hpp"
#include "stopwatch.hpp"

namespace bench {
namespace {

using glm::vec3;

// Screen coordinates have 8 fractional bits; the centre of pixel x is at 256 x + 128.
constexpr int subpixel_bits = 8;
constexpr int subpixels = 1 << subpixel_bits;
constexpr int half = subpixels / 2;

// The pixels whose centres lie between two coordinates.
int first_pixel(std::int32_t low) { return std::max(0, (low + half - 1) >> subpixel_bits); }
int end_pixel(std::int32_t high, int side) {
    return std::min(side, (high + half) >> subpixel_bits);
}

// An edge function: twice the area between an edge and a pixel centre, positive inside. Pixels on
// a top or left edge are inside. Those on other edges are outside: their value is shifted by one.
struct Edge {
    std::int64_t value, across, down, shift;

    template <class Vertex>
    Edge(const Vertex& from, const Vertex& to, int x, int y) {
        const std::int64_t dx = to.x - from.x, dy = to.y - from.y;
        const bool is_inside = dy < 0 || (dy == 0 && dx > 0);
        shift = is_inside ? 0 : 1;
        value = dx * (subpixels * y + half - from.y) - dy * (subpixels * x + half - from.x) - shift;
        across = -dy * subpixels;
        down = dx * subpixels;
    }
};

vec3 to_vec3(const cl_float (&v)[3]) { return {v[0], v[1], v[2]}; }

vec3 normalized(const vec3& v, float addend) {
    return v * (1.0F / std::sqrt(glm::dot(v, v) + addend));
}

// The scene's lighting: the model of shading.clh.
class Light {
public:
    explicit Light(const oit::Lighting& lighting)
        : sky_(to_vec3(lighting.sky)),
          ground_(to_vec3(lighting.ground)),
          key_(to_vec3(lighting.key)),
          to_key_(to_vec3(lighting.key_direction)),
          rim_(to_vec3(lighting.rim)) {}

    [[nodiscard]] vec3 shade(const vec3& tint, float gloss, vec3 normal, const vec3& ray) const {
        normal = normalized(normal, 1e-6F);
        const vec3 to_eye = -normalized(ray, 0);
        const vec3 half_way = normalized(to_eye + to_key_, 1e-6F);
        const vec3 ambient = glm::mix(ground_, sky_, 0.5F + 0.5F * normal.y);
        const float diffuse = std::max(0.0F, glm::dot(normal, to_key_));
        float highlight = std::max(0.0F, glm::dot(normal, half_way));
        for (int i = 0; i < 5; ++i) highlight *= highlight;  // to the power of 32
        const float edge_on = 1 - std::max(0.0F, glm::dot(normal, to_eye));
        return tint * (ambient + diffuse * key_) + gloss * highlight * key_ +
               edge_on * edge_on * edge_on * rim_;
    }

private:
    vec3 sky_, ground_, key_, to_key_, rim_;
};

void require(bool holds, const char* what) {
    if (!holds) throw std::invalid_argument(std::string("plain C++ draws only ") + what);
}

void check(const oit::Frame& frame) {
    require(frame.views.size() == 1, "one eye");
    require(frame.quality.samples == 1, "one sample a pixel");
    for (const oit::Material& material : frame.scene.materials) {
        const auto blend = static_cast<oit::Blend>(material.blend);
        require(blend == oit::Blend::opaque || blend == oit::Blend::over,
                "surfaces that cover or hide");
        require(material.paint == static_cast<cl_uint>(oit::Paint::shaded), "shaded surfaces");
    }
    for (const oit::Model& model : frame.scene.models)
        require(model.opacities.empty() && model.tints.empty(), "surfaces of one colour");
}

}  // namespace

PlainCpp::PlainCpp(const oit::Frame& frame)
    : frame_(frame),
      width_(frame.width()),
      height_(frame.height()),
      lists_(frame.pixels()),
      image_(frame.pixels()) {
    check(frame);
    const oit::Scene& scene = frame.scene;
    if (std::ranges::any_of(scene.instances, [&](const auto& i) { return scene.is_opaque(i); }))
        opaque_.resize(frame.pixels());
}

double PlainCpp::draw() {
    const support::Stopwatch stopwatch;
    if (!opaque_.empty()) {
        std::ranges::fill(opaque_, Opaque{});
        draw_surfaces(true);
    }
    draw_surfaces(false);
    blend();
    return stopwatch.ms();
}

void PlainCpp::project(const support::Mesh& mesh, const raster::RasterInstance& instance) {
    const auto row = [](const cl_float(&r)[4], const vec3& p) {
        return r[0] * p.x + r[1] * p.y + r[2] * p.z + r[3];
    };
    const vec3 normal_x = to_vec3(instance.normal_x), normal_y = to_vec3(instance.normal_y),
               normal_z = to_vec3(instance.normal_z);
    vertices_.resize(mesh.positions.size());
    for (std::size_t i = 0; i < vertices_.size(); ++i) {
        const vec3& p = mesh.positions[i];
        const vec3& n = mesh.normals[i];
        const float depth = row(instance.row_w, p);
        require(depth >= frame_.views[0].near_depth, "what lies in front of the near plane");
        const float inverse = 1 / depth;
        vertices_[i] = {
            static_cast<std::int32_t>(std::lrint(row(instance.row_x, p) * inverse)) + half * width_,
            static_cast<std::int32_t>(std::lrint(row(instance.row_y, p) * inverse)) +
                half * height_,
            inverse,
            {glm::dot(normal_x, n), glm::dot(normal_y, n), glm::dot(normal_z, n)}};
    }
}

// Calls emit(x, y, depth, normal, front) for each pixel whose centre a triangle covers. The normal
// belongs to the visible side.
template <class Emit>
void PlainCpp::scan(const Vertex& a, const Vertex& b, const Vertex& c, const Emit& emit) const {
    const auto [x_low, x_high] = std::minmax({a.x, b.x, c.x});
    const auto [y_low, y_high] = std::minmax({a.y, b.y, c.y});
    const int x_begin = first_pixel(x_low), x_end = end_pixel(x_high, width_);
    const int y_begin = first_pixel(y_low), y_end = end_pixel(y_high, height_);
    if (x_begin >= x_end || y_begin >= y_end) return;  // between the centres, as many are
    const std::int64_t area = static_cast<std::int64_t>(b.x - a.x) * (c.y - a.y) -
                              static_cast<std::int64_t>(b.y - a.y) * (c.x - a.x);
    if (area == 0) return;
    const bool front = area < 0;
    const Vertex& second = front ? c : b;
    const Vertex& third = front ? b : c;

    Edge e0(second, third, x_begin, y_begin), e1(third, a, x_begin, y_begin),
        e2(a, second, x_begin, y_begin);
    const float scale = 1 / static_cast<float>(std::abs(area));
    const float s0 = scale * a.inverse_depth, s1 = scale * second.inverse_depth,
                s2 = scale * third.inverse_depth;
    const float side = front ? 1.0F : -1.0F;
    for (int y = y_begin; y < y_end; ++y) {
        std::int64_t v0 = e0.value, v1 = e1.value, v2 = e2.value;
        for (int x = x_begin; x < x_end; ++x) {
            if ((v0 | v1 | v2) >= 0) {
                // The weights of the corners, each divided by its depth.
                const float p0 = static_cast<float>(v0 + e0.shift) * s0;
                const float p1 = static_cast<float>(v1 + e1.shift) * s1;
                const float p2 = static_cast<float>(v2 + e2.shift) * s2;
                const float depth = 1 / (p0 + p1 + p2);
                emit(x, y, depth,
                     side * depth * (p0 * a.normal + p1 * second.normal + p2 * third.normal),
                     front);
            }
            v0 += e0.across, v1 += e1.across, v2 += e2.across;
        }
        e0.value += e0.down, e1.value += e1.down, e2.value += e2.down;
    }
}

void PlainCpp::draw_surfaces(bool opaque) {
    const raster::View& view = frame_.views[0];
    const vec3 origin = to_vec3(view.ray_origin), ray_x = to_vec3(view.ray_x),
               ray_y = to_vec3(view.ray_y);
    const Light light(frame_.scene.lighting);
    for (const oit::Instance& instance : frame_.scene.instances) {
        if (frame_.scene.is_opaque(instance) != opaque) continue;
        const support::Mesh& mesh = frame_.scene.models[instance.model].mesh;
        const oit::Material& material = frame_.scene.material_of(instance);
        const vec3 tints[]{to_vec3(material.back_tint), to_vec3(material.front_tint)};
        const auto shade = [&](int x, int y, const vec3& normal, bool front) {
            return light.shade(
                tints[front ? 1 : 0], material.gloss, normal,
                origin + static_cast<float>(x) * ray_x + static_cast<float>(y) * ray_y);
        };
        const auto hide = [&](int x, int y, float depth, const vec3& normal, bool front) {
            Opaque& pixel = opaque_[static_cast<std::size_t>(y * width_ + x)];
            if (depth < pixel.depth) pixel = {depth, shade(x, y, normal, front)};
        };
        const auto cover = [&](int x, int y, float depth, const vec3& normal, bool front) {
            const auto pixel = static_cast<std::size_t>(y * width_ + x);
            if (!opaque_.empty() && !(depth < opaque_[pixel].depth)) return;
            lists_[pixel].push_back(
                {depth, material.alpha * shade(x, y, normal, front), material.alpha});
        };
        project(mesh,
                raster::instance_of({.to_world = transform_at(instance, frame_.time)}, view, 0));
        for (const auto& [a, b, c] : mesh.triangles) {
            if (opaque)
                scan(vertices_[a], vertices_[b], vertices_[c], hide);
            else
                scan(vertices_[a], vertices_[b], vertices_[c], cover);
        }
    }
}

// Blends front to back, and empties the lists for the next frame while they are in the cache.
void PlainCpp::blend() {
    const oit::Lighting& lighting = frame_.scene.lighting;
    const auto nearer = [](const Fragment& a, const Fragment& b) { return a.depth < b.depth; };
    std::size_t pixel = 0;
    for (int y = 0; y < height_; ++y) {
        const float down = (static_cast<float>(y) + 0.5F) / static_cast<float>(height_);
        const vec3 background =
            glm::mix(to_vec3(lighting.background_top), to_vec3(lighting.background_bottom), down);
        for (int x = 0; x < width_; ++x, ++pixel) {
            std::vector<Fragment>& list = lists_[pixel];
            std::sort(list.begin(), list.end(), nearer);
            vec3 colour(0.0F);
            float transmittance = 1;
            for (const Fragment& fragment : list) {
                colour += transmittance * fragment.colour;
                transmittance *= 1 - fragment.alpha;
            }
            list.clear();
            const bool hidden = !opaque_.empty() && opaque_[pixel].depth < far;
            colour += transmittance * (hidden ? opaque_[pixel].colour : background);
            image_[pixel] = {{colour.x, colour.y, colour.z, 1}};
        }
    }
}

}  // namespace bench
