#include "trade.hpp"

#include <cmath>
#include <iomanip>
#include <ostream>
#include <string>
#include <vector>

#include "files.hpp"
#include "image_difference.hpp"
#include "json_report.hpp"
#include "number_text.hpp"
#include "progress.hpp"
#include "report.hpp"
#include "stopwatch.hpp"

namespace shadows {
namespace {

struct TradeRow {
    std::string change;  ///< of the options
    Settings settings;
    double ms = 0;
    std::uint64_t rays = 0;
    support::ImageDifference difference;
};

bool divides(int part, int whole) { return part >= 1 && whole % part == 0; }

// The settings of the command line, and others that differ in one of them.
std::vector<TradeRow> rows_around(const Settings& base) {
    std::vector<TradeRow> rows{{"as given", base, 0, 0, {}}};
    const auto add = [&](const std::string& option, int Settings::*setting,
                         std::initializer_list<int> values) {
        for (const int value : values) {
            Settings changed = base;
            changed.*setting = value;
            if (value == base.*setting || !divides(changed.samples, changed.rsm) ||
                !divides(changed.interleave, changed.samples))
                continue;
            rows.push_back({option + " " + std::to_string(value), changed, 0, 0, {}});
        }
    };
    add("--reduce", &Settings::reduce, {1, 2, 4, 8});
    add("--samples", &Settings::samples, {4, 8, 16});
    add("--interleave", &Settings::interleave, {1, 2, 4});
    add("--simplify", &Settings::simplify, {64, 32, 16, 8});
    add("--grid", &Settings::grid, {16, 32, 64, 128, 256});
    return rows;
}

// Everything that blocks, everywhere, from more samples.
Settings all_light(const Settings& base) {
    Settings settings = base;
    settings.reduce = settings.interleave = 1;
    settings.simplify = 0;
    if (divides(2 * base.samples, base.rsm)) settings.samples = 2 * base.samples;
    return settings;
}

std::vector<glm::dvec3> all_light_picture(const cellist::Device& device, const Scene& scene,
                                          const Settings& settings) {
    Renderer renderer(device, scene, settings);
    renderer.draw(scene);
    std::vector<glm::dvec3> picture;
    for (const cl_float4& pixel : renderer.picture().download())
        picture.emplace_back(pixel.s[0], pixel.s[1], pixel.s[2]);
    return picture;
}

nlohmann::ordered_json json_of(const TradeRow& row) {
    nlohmann::ordered_json json{{"options", row.change}};
    json.update(settings_json(row.settings));
    json["ms"] = row.ms;
    json["rays"] = row.rays;
    json["psnr_db"] = support::finite_or_null(row.difference.psnr_db);
    json["ssim"] = row.difference.ssim;
    json["max_abs_error"] = row.difference.max_abs_error;
    return json;
}

}  // namespace

bool run_trade(const cellist::Device& device, const Options& options, const Scene& scene,
               std::ostream& out) {
    const Settings reference_settings = all_light(options.settings);
    std::vector<TradeRow> rows = rows_around(options.settings);
    {
        support::Progress progress("settings");
        const std::vector<glm::dvec3> reference =
            all_light_picture(device, scene, reference_settings);
        for (std::size_t i = 0; i < rows.size(); ++i) {
            TradeRow& row = rows[i];
            progress.update(static_cast<double>(i + 1) / static_cast<double>(rows.size() + 1));
            Renderer renderer(device, scene, row.settings);
            renderer.draw(scene);
            std::vector<double> frames_ms;
            for (std::uint32_t frame = 0; frame < options.frames; ++frame)
                frames_ms.push_back(support::measure_ms(device, [&] { renderer.draw(scene); }));
            row.ms = support::median(frames_ms);
            row.rays = renderer.counts().rays;
            row.difference = support::difference(renderer.picture().download(), reference,
                                                 static_cast<std::size_t>(options.settings.width),
                                                 static_cast<std::size_t>(options.settings.height));
        }
    }

    out << "Error against --reduce 1 --interleave 1 --samples " << reference_settings.samples
        << ", on " << device.info().name << ":\n\n"
        << "options             ms a frame        rays   PSNR dB      SSIM  largest error\n";
    for (const TradeRow& row : rows)
        out << std::left << std::setw(18) << row.change << std::right << std::setw(12)
            << support::fixed(row.ms, 2) << std::setw(12) << support::grouped(row.rays)
            << std::setw(10)
            << (std::isfinite(row.difference.psnr_db) ? support::fixed(row.difference.psnr_db, 1)
                                                      : "equal")
            << std::setw(10) << support::fixed(row.difference.ssim, 4) << std::setw(9)
            << support::fixed(255 * row.difference.max_abs_error, 1) << " / 255\n";

    if (!options.json.empty()) {
        nlohmann::ordered_json json = scene_json(options, device.info().name, device.info().driver);
        json["reference"] = settings_json(reference_settings);
        json["settings"] = nlohmann::ordered_json::array();
        for (const TradeRow& row : rows) json["settings"].push_back(json_of(row));
        support::write_file(options.json, support::dump(json, 2) + '\n');
    }
    return true;
}

}  // namespace shadows
