// SPDX-License-Identifier: MIT
#include "reference.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#ifdef PARTICLES_NANOFLANN
#include <nanoflann.hpp>
#endif

namespace particles {
namespace {

using Point = std::array<float, 3>;

// ---- the definition of a neighbour, operation by operation as in particles.cl

float wrap(float x, float period) {
    const float rest = std::fmod(x, period);
    const float inside = rest < 0 ? rest + period : rest;
    return inside < period ? inside : 0;
}

bool are_neighbours(const Point& a, const Point& b, float radius, float period) {
    std::array<float, 3> d{};
    for (std::size_t i = 0; i < 3; ++i) {
        d[i] = std::fabs(a[i] - b[i]);
        d[i] = std::min(d[i], period - d[i]);
    }
    return std::fma(d[0], d[0], std::fma(d[1], d[1], d[2] * d[2])) <= radius * radius;
}

std::uint32_t hash(std::uint32_t x) {
    x = (x ^ (x >> 16)) * 0x85EBCA6B;
    x = (x ^ (x >> 13)) * 0xC2B2AE35;
    return x ^ (x >> 16);
}

// ---- candidates: every point that could be a neighbour, and maybe others

struct Cloud {
    std::vector<Point> points;
    std::vector<std::uint32_t> ids;

    explicit Cloud(const Scene& scene) {
        for (std::size_t i = 0; i < scene.points.size(); ++i) {
            if (!is_finite(scene.points[i])) continue;
            Point point{};
            for (std::size_t k = 0; k < 3; ++k)
                point[k] = scene.box == Box::periodic ? wrap(scene.points[i].s[k], 1)
                                                      : scene.points[i].s[k];
            points.push_back(point);
            ids.push_back(static_cast<std::uint32_t>(i));
        }
    }

    // What nanoflann asks for.
    [[nodiscard]] std::size_t kdtree_get_point_count() const { return points.size(); }
    [[nodiscard]] double kdtree_get_pt(std::size_t index, std::size_t dimension) const {
        return static_cast<double>(points[index][dimension]);
    }
    template <class T>
    bool kdtree_get_bbox(T&) const {
        return false;
    }
};

#ifdef PARTICLES_NANOFLANN

class Candidates {
public:
    static constexpr const char* method = "nanoflann";
    static constexpr std::size_t sample_max = std::numeric_limits<std::size_t>::max();

    Candidates(const Cloud& cloud, const Scene& scene)
        : periodic_(scene.box == Box::periodic),
          radius_(static_cast<double>(scene.radius) * (1 + 1e-5)),
          tree_(3, cloud) {
        tree_.buildIndex();
    }

    void of(const Point& point, std::vector<std::uint32_t>& out) const {
        out.clear();
        search(point, {0, 0, 0}, 0, out);
        std::sort(out.begin(), out.end());
        out.erase(std::unique(out.begin(), out.end()), out.end());
    }

private:
    // Where nanoflann puts what it finds.
    struct Results {
        double radius_squared;
        std::vector<std::uint32_t>& out;

        bool addPoint(double distance, std::uint32_t index) {  // NOLINT: nanoflann's name
            if (distance <= radius_squared) out.push_back(index);
            return true;
        }
        [[nodiscard]] double worstDist() const { return radius_squared; }  // NOLINT
        [[nodiscard]] std::size_t size() const { return out.size(); }
        [[nodiscard]] bool empty() const { return out.empty(); }
        [[nodiscard]] bool full() const { return true; }
        void sort() {}
    };
    using Metric = nanoflann::L2_Simple_Adaptor<double, Cloud, double, std::uint32_t>;
    using Tree = nanoflann::KDTreeSingleIndexAdaptor<Metric, Cloud, 3, std::uint32_t>;

    // In a periodic box, the images of the point on the other side of the near walls as well.
    void search(const Point& point, std::array<double, 3> shift, std::size_t axis,
                std::vector<std::uint32_t>& out) const {
        if (axis == 3) {
            std::array<double, 3> query{};
            for (std::size_t k = 0; k < 3; ++k) query[k] = static_cast<double>(point[k]) + shift[k];
            Results results{radius_ * radius_, out};
            tree_.findNeighbors(results, query.data(), {});
            return;
        }
        search(point, shift, axis + 1, out);
        if (!periodic_) return;
        const double x = static_cast<double>(point[axis]);
        for (const double side : {1.0, -1.0}) {
            if (x + side < -radius_ || x + side > 1 + radius_) continue;
            shift[axis] = side;
            search(point, shift, axis + 1, out);
        }
    }

    bool periodic_;
    double radius_;
    Tree tree_;
};

#else

class Candidates {
public:
    static constexpr const char* method = "brute force";
    static constexpr std::size_t sample_max = 500;

    Candidates(const Cloud& cloud, const Scene&) : size_(cloud.points.size()) {}

    void of(const Point&, std::vector<std::uint32_t>& out) const {
        out.resize(size_);
        for (std::size_t i = 0; i < size_; ++i) out[i] = static_cast<std::uint32_t>(i);
    }

private:
    std::size_t size_;
};

#endif

// Indices into the cloud: the first 32, where the special points are, then evenly spread.
std::vector<std::size_t> choose(std::size_t points, std::size_t sample) {
    std::vector<std::size_t> chosen;
    const std::size_t first = std::min({points, sample, std::size_t{32}});
    for (std::size_t i = 0; i < first; ++i) chosen.push_back(i);
    const std::size_t rest = points - first;
    const std::size_t more = std::min(rest, sample - first);
    for (std::size_t i = 0; i < more; ++i) chosen.push_back(first + i * rest / more);
    return chosen;
}

}  // namespace

Comparison compare(const Scene& scene, std::span<const cl_uint2> found, std::size_t sample) {
    const float period = scene.box == Box::periodic ? 1.0F : std::numeric_limits<float>::infinity();
    const Cloud cloud(scene);
    Comparison comparison{.method = Candidates::method};
    for (std::size_t i = 0; i < scene.points.size(); ++i)
        if (!is_finite(scene.points[i]) && (found[i].s[0] != 0 || found[i].s[1] != 0))
            ++comparison.different;
    if (cloud.points.empty() || sample == 0) return comparison;

    const Candidates candidates(cloud, scene);
    std::vector<std::uint32_t> near;
    for (const std::size_t i :
         choose(cloud.points.size(), std::min(sample, Candidates::sample_max))) {
        candidates.of(cloud.points[i], near);
        std::uint32_t count = 0;
        std::uint32_t sum = 0;
        for (const std::uint32_t j : near) {
            if (j == i || !are_neighbours(cloud.points[i], cloud.points[j], scene.radius, period))
                continue;
            ++count;
            sum += hash(cloud.ids[j]);
        }
        const cl_uint2& there = found[cloud.ids[i]];
        if (there.s[0] != count || there.s[1] != sum) ++comparison.different;
        ++comparison.points;
    }
    return comparison;
}

}  // namespace particles
