#include "report/frame_json.hpp"

#include <array>
#include <cmath>
#include <ctime>

#include "command_line.hpp"
#include "files.hpp"
#include "number_text.hpp"

namespace oit {
namespace {

using nlohmann::ordered_json;

template <class T>
ordered_json or_null(const std::optional<T>& value) {
    return value ? ordered_json(*value) : ordered_json(nullptr);
}

// ISO 8601, in UTC.
std::string now() {
    const std::time_t time = std::time(nullptr);
    std::tm parts{};
    gmtime_r(&time, &parts);
    std::array<char, 32> text{};
    std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &parts);
    return text.data();
}

}  // namespace

ordered_json finite_or_null(double value) {
    return std::isfinite(value) ? ordered_json(value) : ordered_json(nullptr);
}

double as_read(float value) { return std::stod(support::shortest(value)); }

ordered_json json_of(const std::filesystem::path& path) {
    return path.empty() ? ordered_json(nullptr) : ordered_json(support::text_of(path));
}

ordered_json json_of(const FrameOptions& options, std::string_view program) {
    ordered_json json{
        {"schema", json_schema}, {"program", program}, {"version", support::version()}};
    json["arguments"] = ordered_json::array();
    for (const std::string& argument : options.arguments)
        json["arguments"].push_back(support::text_of(argument));
    json["date"] = now();
    json["scene"] = title_of(options);
    json["width"] = options.width;
    json["height"] = options.height;
    json["stereo"] = or_null(options.eye_separation);
    json["eyes"] = options.eye_separation ? 2 : 1;
    json["view"] = {options.orbit.azimuth_degrees, options.orbit.elevation_degrees};
    json["time_s"] = options.time;
    json["alpha"] = as_read(options.alpha);
    constexpr std::array axes{"file", "x", "y", "z"};
    json["up"] = axes[static_cast<std::size_t>(options.up.value_or(support::UpAxis::unknown))];
    json["blend"] = json_of(std::filesystem::path(blend_text(options)));
    json["opaque_floor"] = options.opaque_floor;
    const Quality& quality = options.quality;
    json["samples"] = quality.samples;
    json["resolve"] = quality.resolve == Resolve::per_pixel ? "pixel" : "sample";
    json["depth_range"] = quality.depth_range;
    json["depth_scale"] = quality.depth_scale == DepthScale::linear ? "linear" : "reversed";
    return json;
}

ordered_json json_of(const Setting& setting) {
    const Quality& quality = setting.quality;
    return {{"options", text(setting)},          {"method", setting.method->name},
            {"exact", setting.method->exact},    {"size", or_null(quality.size)},
            {"layers", or_null(quality.layers)}, {"epsilon", as_read(quality.epsilon)},
            {"format", name_of(quality.format)}};
}

ordered_json times_json(const Measurement& m) {
    return {{"ms", m.milliseconds},
            {"fastest_ms", m.fastest},
            {"lower_quartile_ms", m.lower_quartile},
            {"upper_quartile_ms", m.upper_quartile},
            {"frames", m.times.size()}};
}

ordered_json json_of(const Comparison& c) {
    return {{"psnr_db", finite_or_null(c.psnr_db)},   {"ssim", c.ssim},
            {"max_abs_error", c.max_abs_error},       {"pixels_over_1_255", c.pixels_over},
            {"pixels_explained", c.pixels_explained}, {"pixels_nan", c.pixels_nan}};
}

std::string dump(const ordered_json& json, int indent) {
    return json.dump(indent, ' ', false, ordered_json::error_handler_t::replace);
}

}  // namespace oit
