#include "tradeoff/page.hpp"

#include <cmath>
#include <cstdint>

#include "image.hpp"
#include "json_report.hpp"
#include "report/picture.hpp"
#include "tradeoff/metrics.hpp"
#include "tradeoff_kernels.hpp"

namespace oit {
namespace {

using nlohmann::ordered_json;

// JSON that can stand in a script element: no text in it ends that.
std::string script_text(const ordered_json& json) {
    std::string text;
    for (const char c : support::dump(json, -1))
        text += c == '<' ? std::string("\\u003c") : std::string(1, c);
    return text;
}

void replace(std::string& text, std::string_view mark, const std::string& by) {
    text.replace(text.find(mark), mark.size(), by);
}

}  // namespace

Pictures::Pictures(const Reference& reference, const Frame& frame)
    : frame_(frame), reference_(side_by_side(linear_image(reference), frame)) {
    (void)keep(support::srgb_bytes(reference_, picture_width(frame_)));
}

void Pictures::add(const Setting& setting, const std::vector<cl_float4>& image) {
    const std::vector<cl_float4> picture = side_by_side(image, frame_);
    const std::size_t own = keep(support::srgb_bytes(picture, picture_width(frame_)));
    pictures_[text(setting)] = {own, keep(shown_difference(picture, reference_))};
}

std::size_t Pictures::keep(std::span<const std::uint8_t> bytes) {
    std::string file = support::png(bytes, picture_width(frame_), frame_.height());
    const auto [place, is_new] = known_.emplace(std::move(file), uris_.size());
    if (is_new) uris_.push_back("data:image/png;base64," + base64(place->first));
    return place->second;
}

std::string to_html(const Sweep& sweep, const Pictures& pictures) {
    ordered_json metrics = to_json(sweep);
    for (std::size_t i = 0; i < sweep.measurements.size(); ++i) {
        const Measurement& measurement = sweep.measurements[i];
        if (!measurement.drawn()) continue;
        const auto [picture, difference] = pictures.of(measurement.setting);
        metrics["settings"][i]["picture"] = picture;
        metrics["settings"][i]["difference"] = difference;
    }
    metrics["pictures"] = pictures.uris();
    metrics["difference_factor"] = difference_factor;
    metrics["psnr_enough"] = psnr_enough;
    using namespace tradeoff::kernels;
    std::string page(page_html);
    // From the end to the beginning, so that no mark is sought in what was put in.
    replace(page, "{{script}}", std::string(text_js).append(plot_js).append(page_js));
    replace(page, "{{metrics}}", script_text(metrics));
    replace(page, "{{style}}", std::string(page_css));
    replace(page, "{{title}}", escaped(sweep.scene_name()));
    return page;
}

std::string escaped(std::string_view text) {
    std::string html;
    for (const char c : text) {
        switch (c) {
            case '&':
                html += "&amp;";
                break;
            case '<':
                html += "&lt;";
                break;
            case '>':
                html += "&gt;";
                break;
            case '"':
                html += "&quot;";
                break;
            default:
                html += c;
        }
    }
    return html;
}

std::string base64(std::string_view bytes) {
    constexpr std::string_view digits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t three = 0;
        for (std::size_t j = i; j < i + 3; ++j)
            three = three << 8 | (j < bytes.size() ? static_cast<std::uint8_t>(bytes[j]) : 0U);
        for (std::size_t j = 0; j < 4; ++j)
            text += i + j <= bytes.size() ? digits[three >> (18 - 6 * j) & 63] : '=';
    }
    return text;
}

}  // namespace oit
