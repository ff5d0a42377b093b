// SPDX-License-Identifier: MIT
#include "tradeoff/page.hpp"

#include "image.hpp"
#include "image_difference.hpp"
#include "report/picture.hpp"
#include "tradeoff/metrics.hpp"
#include "tradeoff_kernels.hpp"

namespace oit {

Pictures::Pictures(const Reference& reference, const Frame& frame)
    : frame_(frame), reference_(side_by_side(linear_image(reference), frame)) {
    (void)keep(support::srgb_bytes(reference_, picture_width(frame_)));
}

void Pictures::add(const Setting& setting, const std::vector<cl_float4>& image) {
    const std::vector<cl_float4> picture = side_by_side(image, frame_);
    const std::size_t own = keep(support::srgb_bytes(picture, picture_width(frame_)));
    indices_[text(setting)] = {own, keep(support::shown_difference(picture, reference_))};
}

std::size_t Pictures::keep(std::span<const std::uint8_t> bytes) {
    return pictures_.keep(bytes, picture_width(frame_), frame_.height());
}

std::string to_html(const Sweep& sweep, const Pictures& pictures) {
    nlohmann::ordered_json metrics = to_json(sweep);
    for (std::size_t i = 0; i < sweep.measurements.size(); ++i) {
        const Measurement& measurement = sweep.measurements[i];
        if (!measurement.drawn()) continue;
        const auto [picture, difference] = pictures.of(measurement.setting);
        metrics["settings"][i]["picture"] = picture;
        metrics["settings"][i]["difference"] = difference;
    }
    metrics["psnr_enough"] = psnr_enough;
    using namespace tradeoff::kernels;
    return support::html_page({.title = "cellist-tradeoff: " + sweep.scene_name(),
                               .main = main_html,
                               .text_script = text_js,
                               .main_script = std::string(plot_js).append(page_js)},
                              std::move(metrics), pictures.all());
}

}  // namespace oit
