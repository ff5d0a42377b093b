// SPDX-License-Identifier: MIT
#include "frame/node_layout.hpp"

#include <bit>
#include <cmath>
#include <vector>

namespace oit {
namespace {

// What a format has for every frame: words, room in them, and how many bits opacities take.
struct Base {
    std::uint32_t words;
    std::vector<NodeField> room;
    std::uint32_t alpha_bits;
};

Base base_of(NodeFormat format) {
    switch (format) {
        case NodeFormat::rgba8:
            return {2, {{1, 24, 8}}, 8};
        case NodeFormat::rgba16f:
            return {3, {{2, 16, 16}}, 16};
        case NodeFormat::rgba8_d24c8:
            return {2, {{0, 0, 8}, {1, 24, 8}}, 8};
        case NodeFormat::rgb565_d16:
            return {1, {}, 8};
        default:
            return {4, {}, 32};
    }
}

class Layouter {
public:
    explicit Layouter(Base base) : base_(std::move(base)) {}

    // The first room that is large enough, or a new word.
    NodeField place(std::uint32_t bits) {
        for (NodeField& room : base_.room)
            if (room.bits >= bits) {
                const NodeField field{room.word, room.shift, bits};
                room.shift += bits;
                room.bits -= bits;
                return field;
            }
        base_.room.push_back({base_.words, bits, 32 - bits});
        return {base_.words++, 0, bits};
    }
    [[nodiscard]] std::uint32_t words() const { return base_.words; }
    [[nodiscard]] std::uint32_t alpha_bits() const { return base_.alpha_bits; }

private:
    Base base_;
};

std::string defines_of(const std::string& name, const NodeField& field) {
    if (field.bits == 0) return {};
    const auto line = [&](const std::string& what, std::uint32_t value) {
        return define("OIT_" + name + "_" + what, value);
    };
    return line("WORD", field.word) + line("SHIFT", field.shift) + line("BITS", field.bits);
}

std::uint32_t depth_bits(NodeFormat format) {
    if (format == NodeFormat::rgba8_d24c8) return 24;
    return format == NodeFormat::rgb565_d16 ? 16 : 0;
}

// The greatest power of 2, up to the 0th, that takes the colours of a frame into the range of half.
int half_exponent(float colour_max) {
    constexpr float half_max = 65504;
    return colour_max <= half_max ? 0
                                  : static_cast<int>(std::floor(std::log2(half_max / colour_max)));
}

}  // namespace

NodeLayout node_layout(const Quality& quality, const FrameFeatures& features) {
    Layouter layouter(base_of(quality.format));
    NodeLayout layout{.format = quality.format, .depth_scale = quality.depth_scale};
    if (quality.format == NodeFormat::rgba16f)
        layout.half_exponent = half_exponent(features.colour_max);
    if (quality.samples > 1)
        layout.coverage = layouter.place(static_cast<std::uint32_t>(quality.samples));
    if (features.alpha_varies) layout.alpha = layouter.place(layouter.alpha_bits());
    if (features.blend_varies()) layout.blend = layouter.place(3);
    if (quality.depth_range) layout.depth_range = layouter.place(32);
    if (quality.coverage == Coverage::exact) layout.triangle = layouter.place(32);
    layout.words = layouter.words();
    return layout;
}

std::string defines_of(const NodeLayout& layout) {
    std::string text = define("OIT_NODE", "Node" + std::to_string(layout.words)) +
                       define("OIT_WORDS", layout.words);
    switch (layout.format) {
        case NodeFormat::float32:
            text += "#define OIT_COLOUR_FLOAT\n";
            break;
        case NodeFormat::rgba16f:
            text += "#define OIT_COLOUR_HALF\n#define OIT_HALF_SCALE 0x1p" +
                    std::to_string(layout.half_exponent) + "f\n";
            break;
        case NodeFormat::rgb565_d16:
            text += "#define OIT_COLOUR_565\n";
            break;
        default:  // 8 bits
            break;
    }
    if (const std::uint32_t bits = depth_bits(layout.format); bits > 0)
        text += define("OIT_DEPTH_BITS", bits);
    if (layout.depth_scale == DepthScale::reversed) text += "#define OIT_DEPTH_REVERSED\n";
    text += defines_of("ALPHA", layout.alpha);
    text += defines_of("COVERAGE", layout.coverage);
    text += defines_of("BLEND", layout.blend);
    text += defines_of("DEPTH_RANGE", layout.depth_range);
    text += defines_of("TRIANGLE", layout.triangle);
    return text;
}

double NodeLayout::depth_of(std::uint32_t key, const FrameFeatures& features) const {
    const auto least = static_cast<double>(features.least_depth);
    const auto greatest = static_cast<double>(features.greatest_depth);
    const std::uint32_t bits = depth_bits(format);
    if (bits == 0) {
        if (depth_scale == DepthScale::reversed)
            return 1 / static_cast<double>(std::bit_cast<float>(~key));
        return static_cast<double>(std::bit_cast<float>(key));
    }
    const double part =
        static_cast<double>(key >> (32 - bits)) / static_cast<double>((1U << bits) - 1);
    if (depth_scale == DepthScale::reversed)
        return 1 / (1 / least + part * (1 / greatest - 1 / least));
    return least + part * (greatest - least);
}

DepthResolution NodeLayout::depth_resolution(const FrameFeatures& features) const {
    DepthResolution resolution{.linear = oit::depth_resolution};
    const std::uint32_t bits = depth_bits(format);
    if (bits == 0) {
        // 1 / depth is rounded once more.
        if (depth_scale == DepthScale::reversed) resolution.linear *= 1.125;
        return resolution;
    }
    const auto least = static_cast<double>(features.least_depth);
    const auto greatest = static_cast<double>(features.greatest_depth);
    const double steps = static_cast<double>((1U << bits) - 1);
    // Steps are counted in float, from the least depth.
    const double step = (1 + steps * 0x1p-22) / steps;
    if (depth_scale == DepthScale::linear)
        resolution.constant = (greatest - least) * step;
    else
        resolution.quadratic = (1 / least - 1 / greatest) * step;
    return resolution;
}

}  // namespace oit
