// SPDX-License-Identifier: MIT
#include "page.hpp"

#include "files.hpp"
#include "image.hpp"
#include "motion_page_kernels.hpp"
#include "page/page.hpp"

namespace motion {

std::string to_html(const Report& report) {
    const int width = report.options.settings.width, height = report.options.settings.height;
    nlohmann::ordered_json metrics = to_json(report);
    support::PagePictures pictures;
    const std::vector<cl_float4>& reference = report.reference()->picture;
    (void)pictures.keep(support::srgb_bytes(reference, width), width, height);
    for (std::size_t i = 0; i < report.measurements.size(); ++i) {
        const std::vector<cl_float4>& picture = report.measurements[i].picture;
        metrics["methods"][i]["picture"] =
            pictures.keep(support::srgb_bytes(picture, width), width, height);
        metrics["methods"][i]["difference"] =
            pictures.keep(support::shown_difference(picture, reference), width, height);
    }
    using namespace motion_page::kernels;
    return support::html_page(
        {.title = "cellist-motion-shadows: " + support::text_of(report.options.scene),
         .main = main_html,
         .text_script = text_js,
         .main_script = std::string(page_js)},
        std::move(metrics), pictures);
}

}  // namespace motion
