#include "reference.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace oit {
namespace {

using glm::dvec3;

dvec3 to_double(const cl_float (&v)[3]) { return glm::vec3(v[0], v[1], v[2]); }

// ---- shading: shading.clh in double precision ------------------------------------------------

class Shading {
public:
    Shading(const Look& look, const raster::View& view) : look_(look), view_(view) {}

    [[nodiscard]] dvec3 surface(dvec3 normal, bool front, int x, int y) const {
        if (!front) normal = -normal;
        normal /= std::sqrt(glm::dot(normal, normal) + 1e-6);
        const dvec3 to_eye = -glm::normalize(ray(x, y));
        const dvec3 to_key = to_double(look_.key_direction);
        dvec3 half_way = to_eye + to_key;
        half_way /= std::sqrt(glm::dot(half_way, half_way) + 1e-6);

        const dvec3 ambient =
            glm::mix(to_double(look_.ground), to_double(look_.sky), 0.5 + 0.5 * normal.y);
        const dvec3 key = to_double(look_.key);
        const double diffuse = std::max(0.0, glm::dot(normal, to_key));
        const double highlight = std::pow(std::max(0.0, glm::dot(normal, half_way)), 32);
        const double rim = std::pow(1 - std::max(0.0, glm::dot(normal, to_eye)), 3);
        const dvec3 tint = to_double(front ? look_.front_tint : look_.back_tint);
        return tint * (ambient + diffuse * key) +
               static_cast<double>(look_.gloss) * highlight * key + rim * to_double(look_.rim);
    }

    [[nodiscard]] dvec3 background(int y) const {
        return glm::mix(to_double(look_.background_top), to_double(look_.background_bottom),
                        (y + 0.5) / view_.height);
    }

    [[nodiscard]] dvec3 floor(int x, int y) const {
        const dvec3 r = ray(x, y);
        const double height = r.y < 0 ? std::min(r.y, -1e-4) : std::max(r.y, 1e-4);
        const dvec3 eye = to_double(view_.eye);
        const double distance = (static_cast<double>(look_.floor_height) - eye.y) / height;
        const dvec3 hit = eye + distance * r;
        const dvec3 step_x = to_double(view_.ray_x), step_y = to_double(view_.ray_y);
        const dvec3 across = distance * (step_x - r * (step_x.y / height));
        const dvec3 down = distance * (step_y - r * (step_y.y / height));
        const double squares = 1 / static_cast<double>(look_.floor_square);
        const auto mean = [&](int axis) {
            const double width =
                std::clamp(squares * (std::abs(across[axis]) + std::abs(down[axis])), 1e-2, 1e3);
            return square_wave_mean(squares * hit[axis], width);
        };
        const double checker = 0.5 + 0.5 * mean(0) * mean(2);
        const double from_axis = std::hypot(hit.x, hit.z);
        const double shadow =
            1 - static_cast<double>(look_.floor_shadow) *
                    smooth(1 - from_axis / static_cast<double>(look_.floor_shadow_radius));
        const auto begin = static_cast<double>(look_.floor_fade_begin);
        const auto end = static_cast<double>(look_.floor_fade_end);
        const double fade = smooth((from_axis - begin) / (end - begin));
        const dvec3 paint =
            glm::mix(to_double(look_.floor_dark), to_double(look_.floor_light), checker);
        return glm::mix(paint * shadow, background(y), fade);
    }

private:
    [[nodiscard]] dvec3 ray(int x, int y) const {
        return to_double(view_.ray_origin) + static_cast<double>(x) * to_double(view_.ray_x) +
               static_cast<double>(y) * to_double(view_.ray_y);
    }
    static double smooth(double t) {
        t = std::clamp(t, 0.0, 1.0);
        return t * t * (3 - 2 * t);
    }
    static double square_wave_integral(double x) {
        return 1 - 2 * std::abs(x / 2 - std::floor(x / 2) - 0.5);
    }
    static double square_wave_mean(double middle, double width) {
        return (square_wave_integral(middle + width / 2) -
                square_wave_integral(middle - width / 2)) /
               width;
    }

    const Look& look_;
    const raster::View& view_;
};

// ---- coverage --------------------------------------------------------------------------------

struct Corner {
    std::int64_t x, y;  // sub-pixels
    double w;
    std::array<double, 3> share;
};

struct Sample {
    int x, y;
    double depth;
    std::array<double, 3> weight;
    bool front;
};

// Twice the signed area of a, b, p.
std::int64_t cross(const Corner& a, const Corner& b, std::int64_t x, std::int64_t y) {
    return (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x);
}

bool is_top_or_left(const Corner& a, const Corner& b) {
    return b.y < a.y || (b.y == a.y && b.x > a.x);
}

template <class Emit>
void scan(std::array<Corner, 3> c, const raster::View& view, const Emit& emit) {
    const std::int64_t signed_area = cross(c[0], c[1], c[2].x, c[2].y);
    if (signed_area == 0) return;
    const bool front = signed_area < 0;
    if (front) std::swap(c[1], c[2]);
    const auto area = static_cast<double>(std::abs(signed_area));
    const auto [x_low, x_high] = std::minmax({c[0].x, c[1].x, c[2].x});
    const auto [y_low, y_high] = std::minmax({c[0].y, c[1].y, c[2].y});
    const auto first = [](std::int64_t low) {
        return static_cast<int>(std::max<std::int64_t>(0, low / RASTER_SUBPIXELS - 1));
    };
    const auto last = [](std::int64_t high, int side) {
        return static_cast<int>(std::min<std::int64_t>(side - 1, high / RASTER_SUBPIXELS + 1));
    };
    for (int y = first(y_low); y <= last(y_high, view.height); ++y)
        for (int x = first(x_low); x <= last(x_high, view.width); ++x) {
            const std::int64_t px = std::int64_t{x} * RASTER_SUBPIXELS + RASTER_SUBPIXELS / 2;
            const std::int64_t py = std::int64_t{y} * RASTER_SUBPIXELS + RASTER_SUBPIXELS / 2;
            std::array<double, 3> part{};
            bool covered = true;
            for (std::size_t i = 0; i < 3; ++i) {
                const Corner& a = c[(i + 1) % 3];
                const Corner& b = c[(i + 2) % 3];
                const std::int64_t edge = cross(a, b, px, py);
                covered = covered && (edge > 0 || (edge == 0 && is_top_or_left(a, b)));
                part[i] = static_cast<double>(edge) / area / c[i].w;
            }
            if (!covered) continue;
            const double sum = part[0] + part[1] + part[2];
            Sample sample{x, y, 1 / sum, {}, front};
            for (std::size_t j = 0; j < 3; ++j)
                for (std::size_t i = 0; i < 3; ++i)
                    sample.weight[j] += part[i] / sum * c[i].share[j];
            emit(sample);
        }
}

// Calls emit(triangle, sample) for every covered pixel of every triangle.
template <class Emit>
void draw(const support::Mesh& mesh, const raster::View& view,
          const std::function<void(double)>& progress, const Emit& emit) {
    for (std::size_t index = 0; index < mesh.triangles.size(); ++index) {
        if (progress && index % 1024 == 0)
            progress(static_cast<double>(index) / static_cast<double>(mesh.triangles.size()));
        raster::RasterPolygon polygon{};
        int outside = 0;
        for (int k = 0; k < 3; ++k) {
            const glm::vec3& p = mesh.positions[mesh.triangles[index][static_cast<std::size_t>(k)]];
            polygon.vertex[k] = raster::raster_corner(&view, k, p.x, p.y, p.z);
            outside |= raster::raster_outside(&view, polygon.vertex[k].x, polygon.vertex[k].y,
                                              polygon.vertex[k].w);
        }
        polygon.count = 3;
        if (outside != 0) raster::raster_clip(&view, &polygon);
        const auto corner = [&](int i) {
            const raster::RasterClipVertex& v = polygon.vertex[i];
            return Corner{raster::raster_snap(v.x, v.w, view.width),
                          raster::raster_snap(v.y, v.w, view.height),
                          static_cast<double>(v.w),
                          {static_cast<double>(v.share[0]), static_cast<double>(v.share[1]),
                           static_cast<double>(v.share[2])}};
        };
        for (int piece = 0; piece + 2 < polygon.count; ++piece)
            scan({corner(0), corner(piece + 1), corner(piece + 2)}, view,
                 [&](const Sample& sample) { emit(mesh.triangles[index], sample); });
    }
}

bool too_close(double a, double b) {
    // Infinity is the depth of no surface, which is close to nothing.
    return std::isfinite(a) && std::isfinite(b) &&
           std::abs(a - b) <= depth_resolution * std::max(a, b);
}

}  // namespace

Reference draw_reference(const Frame& frame, const std::function<void(double)>& progress) {
    const raster::View& view = frame.view;
    const Shading shading(frame.look, view);
    const auto width = static_cast<std::size_t>(view.width);
    const std::size_t pixels = width * static_cast<std::size_t>(view.height);
    const auto pixel_of = [&](const Sample& s) {
        return static_cast<std::size_t>(s.y) * width + static_cast<std::size_t>(s.x);
    };

    Reference reference;
    reference.ambiguous.assign(pixels, false);
    std::vector<double> opaque(pixels, std::numeric_limits<double>::infinity());
    if (frame.floor)
        draw(*frame.floor, view, {}, [&](const auto&, const Sample& s) {
            opaque[pixel_of(s)] = std::min(opaque[pixel_of(s)], s.depth);
        });

    std::vector<std::pair<std::size_t, ReferenceFragment>> unordered;
    reference.offsets.assign(pixels + 1, 0);
    draw(frame.mesh, view, progress, [&](const auto& triangle, const Sample& s) {
        const std::size_t pixel = pixel_of(s);
        if (too_close(s.depth, opaque[pixel])) reference.ambiguous[pixel] = true;
        if (!(s.depth < opaque[pixel])) return;
        dvec3 normal(0);
        for (std::size_t j = 0; j < 3; ++j)
            normal += s.weight[j] * dvec3(frame.mesh.normals[triangle[j]]);
        unordered.push_back({pixel, {s.depth, shading.surface(normal, s.front, s.x, s.y)}});
        ++reference.offsets[pixel + 1];
    });
    for (std::size_t p = 0; p < pixels; ++p) reference.offsets[p + 1] += reference.offsets[p];
    reference.fragments.resize(unordered.size());
    std::vector<std::uint64_t> next(reference.offsets.begin(), reference.offsets.end() - 1);
    for (const auto& [pixel, fragment] : unordered) reference.fragments[next[pixel]++] = fragment;

    reference.image.resize(pixels);
    const auto alpha = static_cast<double>(frame.look.alpha);
    for (std::size_t p = 0; p < pixels; ++p) {
        const auto begin =
            reference.fragments.begin() + static_cast<std::ptrdiff_t>(reference.offsets[p]);
        const auto end =
            reference.fragments.begin() + static_cast<std::ptrdiff_t>(reference.offsets[p + 1]);
        std::sort(begin, end, [](const ReferenceFragment& a, const ReferenceFragment& b) {
            return std::tie(a.depth, a.colour.x, a.colour.y, a.colour.z) <
                   std::tie(b.depth, b.colour.x, b.colour.y, b.colour.z);
        });
        const auto length = static_cast<std::uint64_t>(end - begin);
        const std::uint64_t layers = std::min<std::uint64_t>(length, frame.layers.value_or(~0U));
        dvec3 colour(0);
        double transmittance = 1;
        for (std::uint64_t i = 0; i < layers; ++i) {
            const ReferenceFragment& fragment = begin[static_cast<std::ptrdiff_t>(i)];
            colour += transmittance * alpha * fragment.colour;
            transmittance *= 1 - alpha;
            if (i + 1 < length &&
                too_close(fragment.depth, begin[static_cast<std::ptrdiff_t>(i + 1)].depth))
                reference.ambiguous[p] = true;
        }
        const int x = static_cast<int>(p % width), y = static_cast<int>(p / width);
        reference.image[p] = colour + transmittance * (std::isinf(opaque[p]) ? shading.background(y)
                                                                             : shading.floor(x, y));
    }
    return reference;
}

}  // namespace oit
