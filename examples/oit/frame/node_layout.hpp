// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>

#include <cellist/cellist.hpp>

#include "frame/frame_features.hpp"

namespace oit {

// Nodes of 1 to 7 words. The key has the depth in its high bits, so that sorting by it, and by the
// other words where keys are equal, brings the nearest first and is a total order.
struct Node1 {
    cl_uint key;
};
CELLIST_STRUCT(Node1, key);
#define OIT_DEFINE_NODE(words)                                                                     \
    struct Node##words {                                                                           \
        cl_uint key;                                                                               \
        cl_uint rest[(words)-1];                                                                   \
    };                                                                                             \
    CELLIST_STRUCT(Node##words, key, rest)
OIT_DEFINE_NODE(2);
OIT_DEFINE_NODE(3);
OIT_DEFINE_NODE(4);
OIT_DEFINE_NODE(5);
OIT_DEFINE_NODE(6);
OIT_DEFINE_NODE(7);
#undef OIT_DEFINE_NODE

/// The device resolves two depths if they differ by more than this part of the greater one. The
/// device's depth is off by a factor of at most 1 +- 8 * 2^-24 (see draw.clh); two of them by
/// twice that.
inline constexpr double depth_resolution = 16.0 / (1 << 24);

/// Some bits of a word of a node.
struct NodeField {
    std::uint32_t word = 0;
    std::uint32_t shift = 0;
    std::uint32_t bits = 0;  ///< 0 where nodes do not have the field
};

/// How much two depths differ at least if nodes have them in the right order.
struct DepthResolution {
    double constant = 0, linear = 0, quadratic = 0;

    /// Between depths of up to `depth`.
    [[nodiscard]] double at(double depth) const {
        return constant + depth * (linear + depth * quadratic);
    }
};

/// What lies where in the nodes of a frame. Colour and depth lie where the format says; members
/// that only some frames need fill what room the format leaves, or words of their own.
struct NodeLayout {
    NodeFormat format = NodeFormat::float32;
    DepthScale depth_scale = DepthScale::linear;
    std::uint32_t words = 0;
    int half_exponent = 0;       ///< halves hold colours times 2 to this power, 0 or less
    NodeField alpha = {};        ///< a float, a half, or 8 bits
    NodeField coverage = {};     ///< a bit for each sample
    NodeField blend = {};        ///< Blend; 6 where a surface is left
    NodeField depth_range = {};  ///< two halves: how much 1 / depth grows a pixel, along x and y
    NodeField triangle = {};     ///< its number, with exact coverage; the last word

    /// The depth in a key. `features` gives the range of quantised depths.
    [[nodiscard]] double depth_of(std::uint32_t key, const FrameFeatures& features) const;
    [[nodiscard]] DepthResolution depth_resolution(const FrameFeatures& features) const;
};

[[nodiscard]] NodeLayout node_layout(const Quality& quality, const FrameFeatures& features);

/// The macros that fragment.clh is compiled with.
[[nodiscard]] std::string defines_of(const NodeLayout& layout);

/// Calls `use` with a null pointer to the node type of `words` words, and returns what it returns.
/// Throws std::out_of_range where there is none.
auto with_node_type(std::uint32_t words, auto&& use) {
    switch (words) {
        case 1:
            return use(static_cast<const Node1*>(nullptr));
        case 2:
            return use(static_cast<const Node2*>(nullptr));
        case 3:
            return use(static_cast<const Node3*>(nullptr));
        case 4:
            return use(static_cast<const Node4*>(nullptr));
        case 5:
            return use(static_cast<const Node5*>(nullptr));
        case 6:
            return use(static_cast<const Node6*>(nullptr));
        case 7:
            return use(static_cast<const Node7*>(nullptr));
        default:
            throw std::out_of_range("nodes have 1 to 7 words, not " + std::to_string(words));
    }
}

}  // namespace oit
