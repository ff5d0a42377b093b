// SPDX-License-Identifier: MIT
#include "page/page.hpp"

#include "image.hpp"
#include "image_difference.hpp"
#include "json_report.hpp"
#include "page_kernels.hpp"

namespace support {
namespace {

using nlohmann::ordered_json;

// JSON that can stand in a script element: no text in it ends that.
std::string script_text(const ordered_json& json) {
    std::string text;
    for (const char c : dump(json, -1))
        text += c == '<' ? std::string("\\u003c") : std::string(1, c);
    return text;
}

void replace(std::string& text, std::string_view mark, std::string_view by) {
    text.replace(text.find(mark), mark.size(), by);
}

}  // namespace

std::size_t PagePictures::keep(std::span<const std::uint8_t> bytes, int width, int height) {
    const auto [place, is_new] = known_.emplace(png(bytes, width, height), uris_.size());
    if (is_new) uris_.push_back("data:image/png;base64," + base64(place->first));
    return place->second;
}

std::string html_page(const PageParts& parts, ordered_json metrics, const PagePictures& pictures) {
    metrics["pictures"] = pictures.uris();
    metrics["difference_factor"] = difference_factor;
    using namespace page::kernels;
    std::string main(parts.main);
    replace(main, "{{stage}}", stage_html);
    std::string page(page_html);
    // From the end to the beginning, so that no mark is sought in what was put in.
    replace(page, "{{script}}",
            std::string(base_js)
                .append(parts.text_script)
                .append(table_js)
                .append(parts.main_script)
                .append(stage_js));
    replace(page, "{{metrics}}", script_text(metrics));
    replace(page, "{{main}}", main);
    replace(page, "{{style}}", page_css);
    replace(page, "{{title}}", escaped(parts.title));
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

}  // namespace support
