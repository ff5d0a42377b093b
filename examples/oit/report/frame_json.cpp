// SPDX-License-Identifier: MIT
#include "report/frame_json.hpp"

#include <array>

#include "json_report.hpp"
#include "number_text.hpp"

namespace oit {
namespace {

using nlohmann::ordered_json;

const char* name_of(Coverage coverage) { return coverage == Coverage::exact ? "exact" : "samples"; }

template <class T>
ordered_json or_null(const std::optional<T>& value) {
    return value ? ordered_json(*value) : ordered_json(nullptr);
}

}  // namespace

double as_read(float value) { return std::stod(support::shortest(value)); }

ordered_json json_of(const FrameOptions& options, std::string_view program) {
    ordered_json json = support::report_head(json_schema, program, options.arguments);
    json["scene"] = title_of(options);
    json["width"] = options.width;
    json["height"] = options.height;
    json["stereo"] = or_null(options.eye_separation);
    json["eyes"] = options.eye_separation ? 2 : 1;
    json["view"] = {options.orbit.azimuth_degrees, options.orbit.elevation_degrees};
    json["zoom"] = options.orbit.zoom;
    json["time_s"] = options.time;
    json["alpha"] = as_read(options.alpha);
    constexpr std::array axes{"file", "x", "y", "z"};
    json["up"] = axes[static_cast<std::size_t>(options.up.value_or(support::UpAxis::unknown))];
    json["blend"] = support::file_or_null(blend_text(options));
    json["opaque_floor"] = options.opaque_floor;
    json["lens"] = nullptr;
    if (options.lens)
        json["lens"] = {{"radius", options.lens->radius},
                        {"focus", support::finite_or_null(options.lens->focus)}};
    const Quality& quality = options.quality;
    json["samples"] = quality.samples;
    json["coverage"] = options.all_samples ? "all" : name_of(quality.coverage);
    json["resolve"] = quality.resolve == Resolve::per_pixel ? "pixel" : "sample";
    json["depth_range"] = quality.depth_range;
    json["depth_scale"] = quality.depth_scale == DepthScale::linear ? "linear" : "reversed";
    return json;
}

ordered_json json_of(const Setting& setting) {
    const Quality& quality = setting.quality;
    return {{"options", text(setting)},
            {"method", setting.method->name},
            {"exact", setting.method->exact},
            {"size", or_null(quality.size)},
            {"layers", or_null(quality.layers)},
            {"epsilon", as_read(quality.epsilon)},
            {"format", name_of(quality.format)},
            {"samples", quality.samples},
            {"coverage", name_of(quality.coverage)},
            {"lens_rays", quality.lens_rays}};
}

ordered_json times_json(const Measurement& m) {
    return {{"ms", m.milliseconds},
            {"fastest_ms", m.fastest},
            {"lower_quartile_ms", m.lower_quartile},
            {"upper_quartile_ms", m.upper_quartile},
            {"frames", m.times.size()}};
}

ordered_json json_of(const Comparison& c) {
    return {{"psnr_db", support::finite_or_null(c.psnr_db)},
            {"ssim", c.ssim},
            {"max_abs_error", c.max_abs_error},
            {"pixels_over_1_255", c.pixels_over},
            {"pixels_explained", c.pixels_explained},
            {"pixels_nan", c.pixels_nan}};
}

}  // namespace oit
