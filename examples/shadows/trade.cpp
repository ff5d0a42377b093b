// SPDX-License-Identifier: MIT
#include "trade.hpp"

#include <cmath>
#include <iomanip>
#include <map>
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
    support::Least time = {};
    std::uint64_t rays = 0;
    support::ImageDifference of_b = {};    ///< against B at full resolution from all samples
    support::ImageDifference of_all = {};  ///< the same, with the most samples
};

bool divides(int part, int whole) { return part >= 1 && whole % part == 0; }

// The settings of the command line, and others that differ in one of them.
std::vector<TradeRow> rows_around(const Settings& base) {
    std::vector<TradeRow> rows{{"as given", base}};
    const auto add = [&](const std::string& option, int Settings::*setting,
                         std::initializer_list<int> values) {
        for (const int value : values) {
            Settings changed = base;
            changed.*setting = value;
            if (value == base.*setting || !divides(changed.samples, changed.rsm) ||
                !divides(changed.interleave, changed.samples))
                continue;
            rows.push_back({option + " " + std::to_string(value), changed});
        }
    };
    add("--reduce", &Settings::reduce, {1, 2, 4, 8});
    add("--samples", &Settings::samples, {4, 8, 16});
    add("--interleave", &Settings::interleave, {1, 2, 4});
    add("--simplify", &Settings::simplify, {64, 32, 16, 8});
    add("--grid", &Settings::grid, {16, 32, 64, 128, 256});
    return rows;
}

// The picture with B at full resolution, and a ray to every sample.
std::vector<glm::dvec3> full_picture(const cellist::Device& device, const Scene& scene,
                                     Settings settings) {
    settings.reduce = settings.interleave = 1;
    settings.simplify = 0;
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
    json["ms"] = row.time.ms();
    json["rays"] = row.rays;
    json["psnr_db"] = support::finite_or_null(row.of_b.psnr_db);
    json["ssim"] = row.of_b.ssim;
    json["max_abs_error"] = row.of_b.max_abs_error;
    json["psnr_of_all_db"] = support::finite_or_null(row.of_all.psnr_db);
    return json;
}

}  // namespace

bool run_trade(const cellist::Device& device, const Options& options, const Scene& scene,
               std::ostream& out) {
    std::vector<TradeRow> rows = rows_around(options.settings);
    std::map<int, std::vector<glm::dvec3>> references;  // by samples
    const auto width = static_cast<std::size_t>(options.settings.width);
    const auto height = static_cast<std::size_t>(options.settings.height);
    {
        support::Progress progress("settings");
        for (const TradeRow& row : rows) {
            std::vector<glm::dvec3>& reference = references[row.settings.samples];
            if (reference.empty()) reference = full_picture(device, scene, row.settings);
        }
        // In rounds, so that a time in which the machine does other work spoils no row alone.
        for (std::uint32_t round = 0; round < options.frames; ++round)
            for (std::size_t i = 0; i < rows.size(); ++i) {
                TradeRow& row = rows[i];
                progress.update(static_cast<double>(round * rows.size() + i) /
                                static_cast<double>(options.frames * rows.size()));
                Renderer renderer(device, scene, row.settings);
                renderer.draw(scene);
                row.time.add(support::measure_ms(device, [&] { renderer.draw(scene); }));
                if (round > 0) continue;
                row.rays = renderer.counts().rays;
                const std::vector<cl_float4> picture = renderer.picture().download();
                row.of_b = support::difference(picture, references.at(row.settings.samples), width,
                                               height);
                row.of_all =
                    support::difference(picture, references.rbegin()->second, width, height);
            }
    }

    const int most_samples = references.rbegin()->first;
    const auto decibels = [](const support::ImageDifference& difference) {
        return std::isfinite(difference.psnr_db) ? support::fixed(difference.psnr_db, 1) : "equal";
    };
    out << "PSNR of the picture on " << device.info().name
        << ". B: against B at full resolution with a ray to\nevery sample. All: the same with "
        << most_samples << " x " << most_samples << " samples.\n\n"
        << "options           ms a frame        rays      B dB    all dB  SSIM of B  largest "
           "error\n";
    for (const TradeRow& row : rows)
        out << std::left << std::setw(16) << row.change << std::right << std::setw(12)
            << support::fixed(row.time.ms(), 2) << std::setw(12) << support::grouped(row.rays)
            << std::setw(10) << decibels(row.of_b) << std::setw(10) << decibels(row.of_all)
            << std::setw(11) << support::fixed(row.of_b.ssim, 4) << std::setw(9)
            << support::fixed(255 * row.of_b.max_abs_error, 1) << " / 255\n";

    if (!options.json.empty()) {
        nlohmann::ordered_json json = scene_json(options, device.info().name, device.info().driver);
        json["most_samples"] = most_samples;
        json["settings"] = nlohmann::ordered_json::array();
        for (const TradeRow& row : rows) json["settings"].push_back(json_of(row));
        support::write_file(options.json, support::dump(json, 2) + '\n');
    }
    return true;
}

}  // namespace shadows
