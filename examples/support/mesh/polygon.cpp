#include "polygon.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace support {
namespace {

// Twice the signed area. The differences and products of floats are exact in double where their
// magnitudes are near each other, so that the sign is right.
double turn(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
    return (b.x - a.x) * (c.y - b.y) - (b.y - a.y) * (c.x - b.x);
}

}  // namespace

// Fills ring_; false where less than three corners are left.
bool PolygonSplitter::make_ring(std::span<const glm::vec3> corners) {
    ring_.clear();
    const auto same = [&](std::uint32_t a, std::uint32_t b) { return corners[a] == corners[b]; };
    for (std::uint32_t i = 0; i < corners.size(); ++i) {
        if (ring_.size() > 1 && same(ring_[ring_.size() - 2], i)) ring_.pop_back();
        if (ring_.empty() || !same(ring_.back(), i)) ring_.push_back(i);
    }
    std::size_t begin = 0;
    while (ring_.size() - begin > 2) {
        const std::size_t end = ring_.size();
        if (same(ring_[begin], ring_[end - 1]) || same(ring_[begin], ring_[end - 2]))
            ring_.pop_back();
        else if (same(ring_[begin + 1], ring_[end - 1]))
            ++begin;
        else
            break;
    }
    ring_.erase(ring_.begin(), ring_.begin() + static_cast<std::ptrdiff_t>(begin));
    return ring_.size() > 2;
}

// Fills points_ with the corners in the plane, counter-clockwise; false where they have no area.
bool PolygonSplitter::project(std::span<const glm::vec3> corners) {
    const glm::dvec3 origin(corners[ring_[0]]);
    glm::dvec3 normal(0), extent(0);
    glm::dvec3 last = glm::dvec3(corners[ring_.back()]) - origin;
    for (const std::uint32_t i : ring_) {
        const glm::dvec3 here = glm::dvec3(corners[i]) - origin;
        normal += glm::cross(last, here);
        extent = glm::max(extent, glm::abs(here));
        last = here;
    }
    const glm::dvec3 size = glm::abs(normal);
    const int axis = size.x >= size.y ? (size.x >= size.z ? 0 : 2) : (size.y >= size.z ? 1 : 2);
    const double largest = std::max({extent.x, extent.y, extent.z});
    area_ = size[axis];
    // Less than the rounding of the corners makes.
    if (!(area_ > 1e-14 * largest * largest)) return false;
    int u = (axis + 1) % 3, v = (axis + 2) % 3;
    if (normal[axis] < 0) std::swap(u, v);
    points_.clear();
    for (const std::uint32_t i : ring_)
        points_.emplace_back(static_cast<double>(corners[i][u]),
                             static_cast<double>(corners[i][v]));
    return true;
}

// Whether the boundary turns round once, as that of every polygon without crossings does.
bool PolygonSplitter::turns_once() const {
    double sum = 0;
    for (std::uint32_t i = 0; i < points_.size(); ++i) {
        const glm::dvec2 in = points_[i] - points_[previous_[i]];
        const glm::dvec2 out = points_[next_[i]] - points_[i];
        const double cross = in.x * out.y - in.y * out.x, dot = glm::dot(in, out);
        if (cross == 0 && dot <= 0) return true;  // a spike: to the left or to the right
        sum += std::atan2(cross, dot);
    }
    return std::lround(sum / (2 * std::numbers::pi)) == 1;
}

double PolygonSplitter::turn_at(std::uint32_t corner) const {
    return turn(points_[previous_[corner]], points_[corner], points_[next_[corner]]);
}

double PolygonSplitter::area_left() const {
    std::uint32_t corner = 0;
    while (clipped_[corner]) ++corner;
    double sum = 0;
    const std::uint32_t first = corner;
    for (corner = next_[first]; next_[corner] != first; corner = next_[corner])
        sum += turn(points_[first], points_[corner], points_[next_[corner]]);
    return sum;
}

bool PolygonSplitter::blocks(std::uint32_t corner, std::uint32_t ear, bool touching_blocks) const {
    if (!reflex_[corner]) return false;
    const std::uint32_t before = previous_[ear], after = next_[ear];
    if (corner == before || corner == ear || corner == after) return false;
    const glm::dvec2 &a = points_[before], &b = points_[ear], &c = points_[after];
    const glm::dvec2& p = points_[corner];
    if (p == a || p == c) return false;
    if (p == b) {
        // The boundary touches the ear's tip: it may come from within.
        const auto depth = [&](const glm::dvec2& q) {
            return std::min(turn(a, b, q), turn(b, c, q));
        };
        const double in = depth(points_[previous_[corner]]), out = depth(points_[next_[corner]]);
        return in > 0 || out > 0 || (in == 0 && out == 0);
    }
    const double least = std::min({turn(a, b, p), turn(b, c, p), turn(c, a, p)});
    return touching_blocks ? least >= 0 : least > 0;
}

// A reflex corner that lies in the ear; none where the ear can be clipped.
std::uint32_t PolygonSplitter::blocker_of(std::uint32_t ear, bool touching_blocks) {
    std::uint64_t steps = 0;
    const std::uint32_t blocker = reflex_corners_.find(
        {points_[previous_[ear]], points_[ear], points_[next_[ear]]}, steps,
        [&](std::uint32_t corner) { return blocks(corner, ear, touching_blocks); });
    work_left_ -= std::min(work_left_, steps);
    return blocker;
}

// Looks again at the corners that waited for this one.
void PolygonSplitter::wake(std::uint32_t corner) {
    for (std::uint32_t i = first_waiting_[corner]; i != none; i = waiting_[i].next)
        queue_.push_back(waiting_[i].corner);
    first_waiting_[corner] = none;
}

void PolygonSplitter::clip(std::uint32_t ear, std::vector<Triangle>& triangles) {
    const std::uint32_t before = previous_[ear], after = next_[ear];
    triangles.push_back({ring_[before], ring_[ear], ring_[after]});
    clipped_[ear] = true;
    next_[before] = after;
    previous_[after] = before;
    --left_;
    wake(ear);
    for (const std::uint32_t corner : {before, after}) {
        if (reflex_[corner] && turn_at(corner) > 0) {
            reflex_[corner] = false;
            reflex_corners_.remove(corner);
            wake(corner);
        }
        if (!reflex_[corner]) queue_.push_back(corner);
    }
}

// Clips ears until three corners are left; false where there are none before that.
bool PolygonSplitter::clip_ears(bool touching_blocks, std::vector<Triangle>& triangles) {
    const auto count = static_cast<std::uint32_t>(points_.size());
    queue_.clear();
    first_waiting_.assign(count, none);
    waiting_.clear();
    for (std::uint32_t i = 0; i < count; ++i)
        if (!clipped_[i] && !reflex_[i]) queue_.push_back(i);
    for (std::size_t at = 0; at < queue_.size() && left_ > 3 && work_left_ > 0; ++at) {
        const std::uint32_t ear = queue_[at];
        if (clipped_[ear] || !(turn_at(ear) > 0)) continue;
        const std::uint32_t blocker = blocker_of(ear, touching_blocks);
        if (blocker == none) {
            clip(ear, triangles);
        } else {
            waiting_.push_back({ear, first_waiting_[blocker]});
            first_waiting_[blocker] = static_cast<std::uint32_t>(waiting_.size() - 1);
        }
    }
    return left_ == 3;
}

PolygonSplitter::Result PolygonSplitter::split(std::span<const glm::vec3> corners,
                                               std::vector<Triangle>& triangles) {
    if (!make_ring(corners) || !project(corners)) return Result::flat;
    const auto count = static_cast<std::uint32_t>(points_.size());
    previous_.resize(count);
    next_.resize(count);
    for (std::uint32_t i = 0; i < count; ++i) {
        previous_[i] = i == 0 ? count - 1 : i - 1;
        next_[i] = i + 1 == count ? 0 : i + 1;
    }
    if (!turns_once()) return Result::crossing;
    reflex_.resize(count);
    std::vector<std::uint32_t> reflex;
    for (std::uint32_t i = 0; i < count; ++i) {
        reflex_[i] = !(turn_at(i) > 0);
        if (reflex_[i]) reflex.push_back(i);
    }
    if (reflex.empty()) {
        for (std::uint32_t i = 2; i < count; ++i)
            triangles.push_back({ring_[0], ring_[i - 1], ring_[i]});
        return Result::split;
    }

    clipped_.assign(count, false);
    left_ = count;
    reflex_corners_.build(points_, std::move(reflex));
    const std::size_t before = triangles.size();
    // Where the boundary touches itself, an ear may have a corner on its edge.
    const bool done = clip_ears(true, triangles) || clip_ears(false, triangles);
    const double rest = area_left();
    if (done && rest > 0) {
        std::uint32_t corner = 0;
        while (clipped_[corner]) ++corner;
        triangles.push_back({ring_[previous_[corner]], ring_[corner], ring_[next_[corner]]});
        return Result::split;
    }
    if (std::abs(rest) <= 1e-12 * area_) return Result::split;
    triangles.resize(before);
    return work_left_ == 0 ? Result::too_long : Result::crossing;
}

}  // namespace support
