// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <cellist/cellist.hpp>

#include "budget/budget.hpp"
#include "budget/setting.hpp"
#include "budget/survey.hpp"
#include "frame/frame.hpp"
#include "reference/reference.hpp"

namespace oit {

/// The picture of a frame in double precision. Where depths as float do not tell the order of its
/// layers, any order is as right, and so is the picture that the device draws of all layers in
/// float.
class Truth {
public:
    /// Draws both. Blocks.
    Truth(const cellist::Device& device, const Frame& frame);

    /// `image` is linear, eye by eye. PictureErrors::all are those against the reference;
    /// PictureErrors::resolved are, in pixels with an unresolved order, against the nearest of
    /// those.
    [[nodiscard]] PictureErrors errors_of(std::span<const cl_float4> image) const;

    [[nodiscard]] const Reference& reference() const { return reference_; }
    [[nodiscard]] std::uint64_t pixels_ambiguous() const;

private:
    using Colour = std::array<double, 3>;  // encoded

    Reference reference_;
    std::map<std::size_t, std::vector<Colour>> as_right_;  // by pixel with an unresolved order
};

/// Milliseconds of a frame.
struct FrameTimes {
    double median_ms = 0;
    double least_ms = 0;
    std::size_t runs = 0;
};

/// A setting, and what it costs and gives.
struct SettingMeasurement {
    Setting setting;
    std::string failure = {};  ///< why it could not be drawn; then there are no metrics
    PictureErrors errors = {};
    FrameTimes times = {};
};

/// All settings of a frame, drawn and measured, and the best of them for a budget.
///
/// Settings draw interleaved, so that other work on the machine slows all of them alike. One that
/// takes far longer than all layers in float with the method `linked`, which keeps every budget
/// that can be kept, is drawn twice only.
class ExhaustiveSearch {
public:
    /// Draws each setting `runs` times at least, and keeps all renderers. Blocks. Refers to the
    /// device and the frame, which must outlive it. Throws std::runtime_error where the device
    /// cannot draw all layers in float.
    ExhaustiveSearch(const cellist::Device& device, const Frame& frame, std::uint32_t runs);
    ExhaustiveSearch(const ExhaustiveSearch&) = delete;
    ExhaustiveSearch& operator=(const ExhaustiveSearch&) = delete;
    ~ExhaustiveSearch();

    [[nodiscard]] const Truth& truth() const { return truth_; }
    [[nodiscard]] const std::vector<SettingMeasurement>& measurements() const {
        return measurements_;
    }

    /// The cheapest setting within the budget: those that are nearly as cheap draw again, more
    /// often. Nothing where there is none. Blocks.
    [[nodiscard]] const SettingMeasurement* best(const Budget& budget);

    /// Nothing where the setting is not among those of the frame.
    [[nodiscard]] const SettingMeasurement* find(const Setting& setting) const;

    /// The times of these settings, measured again, interleaved and more often. Blocks.
    [[nodiscard]] std::vector<FrameTimes> time_again(
        std::span<const SettingMeasurement* const> measurements);

private:
    struct Drawn;

    void draw(const cellist::Device& device, const Frame& frame, SettingMeasurement& measurement);
    void time_all();
    [[nodiscard]] std::vector<FrameTimes> draw_interleaved(
        std::span<const SettingMeasurement* const> measurements, std::uint32_t runs);
    [[nodiscard]] Drawn& drawn(const SettingMeasurement& measurement) {
        return *drawn_[static_cast<std::size_t>(&measurement - measurements_.data())];
    }

    const Frame& frame_;
    Truth truth_;
    std::uint32_t runs_;
    std::vector<SettingMeasurement> measurements_;
    std::vector<std::unique_ptr<Drawn>> drawn_;  ///< of each measurement; none where it failed
};

}  // namespace oit
