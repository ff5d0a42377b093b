// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "budget/survey_result.hpp"
#include "frame/fragment_source.hpp"

namespace oit {

/// The depths of all fragments that a method stores, by pixel.
struct StoredDepths {
    std::vector<std::uint64_t> offsets;  ///< pixels + 1
    std::vector<double> depths;          ///< in no order within a pixel
};

/// A way from fragments to an image. Each has a file in methods/, which puts it into the table.
class Method {
public:
    Method() = default;
    Method(const Method&) = delete;
    Method& operator=(const Method&) = delete;
    virtual ~Method() = default;

    /// Stores what the image needs of the fragments: enqueues passes of the source. May block.
    virtual void store() = 0;

    /// Makes the image, with kernels of the source over the pixels. Does not block.
    virtual void resolve() = 0;

    /// Stores fragments, calls a function, and makes the image. May block in store().
    virtual void draw(const std::function<void()>& stored) {
        store();
        stored();
        resolve();
    }

    /// Waits for the image. False if fragments had no room: the method makes room, and the frame
    /// begins again at store().
    [[nodiscard]] virtual bool finish_or_grow() { return true; }

    /// What the method keeps on the device, beside what the source has.
    [[nodiscard]] virtual std::uint64_t device_bytes() const = 0;

    /// The image is blended in store() already, slice by slice.
    [[nodiscard]] virtual bool blends_slices() const { return false; }
    /// Parts of the image that the last frame was built in, one after the other.
    [[nodiscard]] virtual std::uint32_t slices() const { return 1; }
    /// Fragments in each pixel, where the method has all of them. Blocks.
    [[nodiscard]] virtual std::optional<cellist::Lengths> lengths() const { return {}; }
    /// Their depths, for comparisons. Blocks.
    [[nodiscard]] virtual std::optional<StoredDepths> depths() const { return {}; }
};

/// For methods of which no bound is known.
[[nodiscard]] std::optional<PictureError> no_bound(const SurveyResult& scene,
                                                   const Quality& quality);
/// Of methods that blend all layers, packed in their order; or the nearest, or until little light
/// passes, in float.
[[nodiscard]] std::optional<PictureError> bound_of_layers(const SurveyResult& scene,
                                                          const Quality& quality);
[[nodiscard]] std::uint64_t one_pass(const SurveyResult& scene, const Quality& quality);
[[nodiscard]] std::uint64_t two_passes(const SurveyResult& scene, const Quality& quality);

/// A line of the table of methods.
struct MethodInfo {
    std::string_view name;
    std::string_view summary;  ///< what it does and where it comes from, in one line
    int position;              ///< in the table: in steps of 10, so that a method fits between two
    bool exact;                ///< the image of all fragments, up to rounding
    bool cuts = false;         ///< tried with fewer layers and early ends
    bool has_nodes = true;     ///< keeps fragments as nodes, in Quality::format
    bool draws_views = false;  ///< draws pictures of its own, so that a lens needs no margin
    /// What it can be compiled for (layers, trials, steps ...), smallest first: Quality::size.
    /// Nothing where there is no such choice.
    std::span<const std::uint32_t> sizes = {};
    /// Why it cannot draw a frame, or nothing.
    std::string (*refusal)(const Frame& frame, const FrameFeatures& features);
    /// Refers to the source, which must outlive the method.
    std::unique_ptr<Method> (*make)(FragmentSource& source);
    /// The error of its picture at most, apart from what depends on an order that float depths do
    /// not tell; nothing where theory has no bound.
    std::optional<PictureError> (*bound)(const SurveyResult& scene,
                                         const Quality& quality) = no_bound;
    /// How often it draws the transparent surfaces, at least.
    std::uint64_t (*passes)(const SurveyResult& scene, const Quality& quality) = one_pass;
};

/// Puts a method into the table: a constant in the method's file.
class MethodRegistration {
public:
    explicit MethodRegistration(const MethodInfo& info);
};

/// All methods, by position.
[[nodiscard]] std::span<const MethodInfo> methods();

/// Throws InputError, with the names there are, where there is none of this name.
[[nodiscard]] const MethodInfo& method_named(std::string_view name);

/// The text of a size. Throws InputError, with the sizes there are, where the method has no such
/// size.
[[nodiscard]] std::uint32_t read_size_of(const MethodInfo& method, const std::string& text);

/// For methods that do not keep all fragments: why they cannot draw a frame that needs them, or
/// nothing.
[[nodiscard]] std::string needs_all_fragments(const Frame& frame);

/// For methods that draw through a lens only.
[[nodiscard]] std::string refuses_pinholes(const Frame& frame, const FrameFeatures& features);

}  // namespace oit
