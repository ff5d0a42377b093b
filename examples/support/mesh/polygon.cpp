// SPDX-License-Identifier: MIT
#include "polygon.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace support {
namespace {

// Twice the signed area. Differences and products of floats of similar magnitude are exact in
// double, so the sign is right.
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

// Fills points_ with the corners in the plane, counter-clockwise; false if their area is 0.
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
    // An area smaller than the rounding error of the corners counts as 0.
    if (!(area_ > 1e-14 * largest * largest)) return false;
    int u = (axis + 1) % 3, v = (axis + 2) % 3;
    if (normal[axis] < 0) std::swap(u, v);
    points_.clear();
    for (const std::uint32_t i : ring_)
        points_.emplace_back(static_cast<double>(corners[i][u]),
                             static_cast<double>(corners[i][v]));
    return true;
}

void PolygonSplitter::make_nodes() {
    const auto count = static_cast<std::uint32_t>(points_.size());
    nodes_.clear();
    for (std::uint32_t i = 0; i < count; ++i)
        nodes_.push_back({i, i == 0 ? count - 1 : i - 1, i + 1 == count ? 0 : i + 1, none});
}

// Whether the boundary makes one full turn, as that of every polygon without crossings does.
bool PolygonSplitter::turns_once() const {
    double sum = 0;
    for (const Node& node : nodes_) {
        const glm::dvec2 in = points_[node.corner] - place(node.previous);
        const glm::dvec2 out = place(node.next) - points_[node.corner];
        const double cross = in.x * out.y - in.y * out.x, dot = glm::dot(in, out);
        if (cross == 0 && dot <= 0) return true;  // a spike: to the left or to the right
        sum += std::atan2(cross, dot);
    }
    return std::lround(sum / (2 * std::numbers::pi)) == 1;
}

double PolygonSplitter::turn_at(std::uint32_t node) const {
    return turn(place(nodes_[node].previous), place(node), place(nodes_[node].next));
}

// The reflex node at a corner from which a diagonal to the ear runs inside; none where there is no
// such node.
std::uint32_t PolygonSplitter::node_facing(std::uint32_t corner, std::uint32_t ear,
                                           std::uint64_t& steps) const {
    const Node& tip = nodes_[ear];
    const glm::dvec2& b = place(ear);
    for (std::uint32_t n = corner; n != none; n = nodes_[n].same) {
        ++steps;
        const Node& node = nodes_[n];
        if (node.clipped || !node.reflex || n == ear || n == tip.previous || n == tip.next)
            continue;
        const glm::dvec2 &before = place(node.previous), &here = place(n),
                         &after = place(node.next);
        if (here == b) {
            // The boundary touches the tip of the ear, and may reach it from inside the ear.
            const auto depth = [&](const glm::dvec2& q) {
                return std::min(turn(place(tip.previous), b, q), turn(b, place(tip.next), q));
            };
            const double in = depth(before), out = depth(after);
            if (in > 0 || out > 0 || (in == 0 && out == 0)) return n;
        } else if (!(turn(here, after, b) < 0 && turn(before, here, b) < 0)) {
            return n;
        }
    }
    return none;
}

// The node that lies deepest in the ear; none where the ear can be clipped.
std::uint32_t PolygonSplitter::deepest_in(std::uint32_t ear) {
    const glm::dvec2& a = place(nodes_[ear].previous);
    const glm::dvec2& b = place(ear);
    const glm::dvec2& c = place(nodes_[ear].next);
    std::uint64_t steps = 0;  // of the tree, and at corners with several nodes
    const std::uint32_t corner =
        reflex_corners_.deepest({a, b, c}, steps, [&](std::uint32_t candidate) {
            const glm::dvec2& p = points_[candidate];
            if (p == a || p == c) return -1.0;
            const double depth = turn(c, a, p);
            if (!(depth >= 0) || turn(a, b, p) < 0 || turn(b, c, p) < 0) return -1.0;
            return node_facing(candidate, ear, steps) == none ? -1.0 : depth;
        });
    const std::uint32_t node = corner == none ? none : node_facing(corner, ear, steps);
    work_left_ -= std::min(work_left_, steps);
    return node;
}

std::uint32_t PolygonSplitter::add_node(std::uint32_t corner, std::uint32_t previous,
                                        std::uint32_t next) {
    const auto added = static_cast<std::uint32_t>(nodes_.size());
    nodes_.push_back({corner, previous, next, nodes_[corner].same});
    nodes_[corner].same = added;
    nodes_[previous].next = added;
    nodes_[next].previous = added;
    return added;
}

// After a change at this node: its angle became smaller.
void PolygonSplitter::update(std::uint32_t n) {
    Node& node = nodes_[n];
    if (turn_at(n) > 0) {
        if (node.reflex && --reflex_nodes_[node.corner] == 0) reflex_corners_.remove(node.corner);
        node.reflex = false;
        queue_.push_back(n);
    }
}

void PolygonSplitter::clip(std::uint32_t ear, std::vector<Triangle>& triangles) {
    const std::uint32_t before = nodes_[ear].previous, after = nodes_[ear].next;
    triangles.push_back(
        {ring_[nodes_[before].corner], ring_[nodes_[ear].corner], ring_[nodes_[after].corner]});
    clipped_area_ += turn_at(ear);
    nodes_[ear].clipped = true;
    nodes_[before].next = after;
    nodes_[after].previous = before;
    if (nodes_[after].next == before) {
        nodes_[before].clipped = nodes_[after].clipped = true;
        return;
    }
    update(before);
    update(after);
}

// Swaps the successors of two nodes at one place.
void PolygonSplitter::exchange(std::uint32_t a, std::uint32_t b) {
    std::swap(nodes_[a].next, nodes_[b].next);
    nodes_[nodes_[a].next].previous = a;
    nodes_[nodes_[b].next].previous = b;
    update(a);
    update(b);
}

// Cuts along the diagonal, or where the boundary touches itself at the tip or on an edge of the
// ear.
void PolygonSplitter::cut(std::uint32_t ear, std::uint32_t deepest) {
    const std::uint32_t before = nodes_[ear].previous, after = nodes_[ear].next;
    const glm::dvec2 p = place(deepest), a = place(before), b = place(ear), c = place(after);
    const auto copy = [&](std::uint32_t node, std::uint32_t previous, std::uint32_t next) {
        const std::uint32_t added = add_node(nodes_[node].corner, previous, next);
        nodes_[added].reflex = true;
        ++reflex_nodes_[nodes_[added].corner];
        return added;
    };
    if (p == b) {
        exchange(ear, deepest);
    } else if (turn(a, b, p) == 0) {
        exchange(copy(deepest, before, ear), deepest);
    } else if (turn(b, c, p) == 0) {
        exchange(copy(deepest, ear, after), deepest);
    } else {
        const std::uint32_t last = nodes_[deepest].previous;
        const std::uint32_t tip = copy(ear, ear, after);
        const std::uint32_t end = copy(deepest, last, tip);
        nodes_[ear].next = deepest;
        nodes_[deepest].previous = ear;
        for (const std::uint32_t node : {ear, tip, deepest, end}) update(node);
    }
}

void PolygonSplitter::clip_and_cut(std::vector<Triangle>& triangles) {
    const std::size_t most_nodes = 4 * points_.size();
    for (std::size_t at = 0; at < queue_.size() && work_left_ > 0; ++at) {
        const std::uint32_t ear = queue_[at];
        if (nodes_[ear].clipped || !(turn_at(ear) > 0)) continue;
        const std::uint32_t deepest = deepest_in(ear);
        if (deepest == none) {
            clip(ear, triangles);
        } else {
            if (nodes_.size() > most_nodes || queue_.size() > 4 * most_nodes) return;
            cut(ear, deepest);
        }
    }
}

PolygonSplitter::Result PolygonSplitter::split(std::span<const glm::vec3> corners,
                                               std::vector<Triangle>& triangles) {
    if (corners.size() > work_left_ / 16) return Result::too_long;
    if (!make_ring(corners) || !project(corners)) return Result::flat;
    const auto count = static_cast<std::uint32_t>(points_.size());
    make_nodes();
    queue_.clear();
    reflex_nodes_.assign(count, 0);
    std::vector<std::uint32_t> reflex;
    for (std::uint32_t i = 0; i < count; ++i) {
        nodes_[i].reflex = !(turn_at(i) > 0);
        reflex_nodes_[i] = nodes_[i].reflex ? 1 : 0;
        if (nodes_[i].reflex)
            reflex.push_back(i);
        else
            queue_.push_back(i);
    }
    // Four left turns of less than 180 degrees each make exactly one full turn.
    const bool is_convex_quad = count == 4 && reflex.empty();
    if (!is_convex_quad && !turns_once()) return Result::crossing;
    if (reflex.empty()) {
        for (std::uint32_t i = 2; i < count; ++i)
            triangles.push_back({ring_[0], ring_[i - 1], ring_[i]});
        return Result::split;
    }
    reflex_corners_.build(points_, std::move(reflex));
    const std::size_t before = triangles.size();
    clipped_area_ = 0;
    clip_and_cut(triangles);
    if (std::abs(clipped_area_ - area_) <= 1e-9 * area_) return Result::split;
    triangles.resize(before);
    return work_left_ == 0 ? Result::too_long : Result::crossing;
}

}  // namespace support
