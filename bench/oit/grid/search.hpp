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
/// layers, any order is as right, and so is the picture that the device draws of all layers in float.
class Truth {
public:
    /// Draws both. Blocks.
    Truth(const cellist::Device& device, const Frame& frame);

    /// `image` is linear, eye by eye. PictureErrors::all are those against the reference;
    /// PictureErrors::told are, in pixels whose order is not told, against the nearest of those.
    [[nodiscard]] PictureErrors errors_of(std::span<const cl_float4> image) const;

    [[nodiscard]] const Reference& reference() const { return reference_; }
    [[nodiscard]] std::uint64_t pixels_ambiguous() const;

private:
    using Colour = std::array<double, 3>;  // encoded

    Reference reference_;
    std::map<std::size_t, std::vector<Colour>> as_right_;  // by pixel whose order is not told
};

/// Milliseconds of a frame.
struct FrameTimes {
    double median_ms = 0;
    double least_ms = 0;
    std::size_t runs = 0;
};

/// A setting, and what it costs and gives.
struct Trial {
    Setting setting;
    std::string failure = {};  ///< why it could not be drawn; then there are no figures
    PictureErrors errors = {};
    FrameTimes times = {};
};

/// All settings of a frame, drawn and measured, and the best of them for a budget.
///
/// Settings draw by turns, so that what else the machine does disturbs all alike. One that takes
/// far longer than all layers in float with the method `linked`, which keeps every budget that can
/// be kept, is drawn twice only.
class Search {
public:
    /// Draws each setting `runs` times at least, and keeps all renderers. Blocks. Refers to the
    /// device and the frame, which must outlive it. Throws std::runtime_error where the device cannot
    /// draw all layers in float.
    Search(const cellist::Device& device, const Frame& frame, std::uint32_t runs);
    Search(const Search&) = delete;
    Search& operator=(const Search&) = delete;
    ~Search();

    [[nodiscard]] const Truth& truth() const { return truth_; }
    [[nodiscard]] const std::vector<Trial>& trials() const { return trials_; }

    /// The cheapest setting within the budget: those that are nearly as cheap draw again, more
    /// often. Nothing where there is none. Blocks.
    [[nodiscard]] const Trial* best(const Budget& budget);

    /// Nothing where the setting is not among those of the frame.
    [[nodiscard]] const Trial* find(const Setting& setting) const;

    /// The times of these settings, measured again by turns, more often. Blocks.
    [[nodiscard]] std::vector<FrameTimes> time_again(std::span<const Trial* const> trials);

private:
    struct Drawn;

    void draw(const cellist::Device& device, const Frame& frame, Trial& trial);
    void time_all();
    [[nodiscard]] std::vector<FrameTimes> draw_by_turns(std::span<const Trial* const> trials,
                                                        std::uint32_t runs);
    [[nodiscard]] Drawn& drawn(const Trial& trial) {
        return *drawn_[static_cast<std::size_t>(&trial - trials_.data())];
    }

    const Frame& frame_;
    Truth truth_;
    std::uint32_t runs_;
    std::vector<Trial> trials_;
    std::vector<std::unique_ptr<Drawn>> drawn_;  ///< of each trial; none where it failed
};

}  // namespace oit
