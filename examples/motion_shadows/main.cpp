// SPDX-License-Identifier: MIT
// Motion-blurred shadows from depth-time ranges, and from other methods.
#include <iostream>
#include <vector>

#include <cellist/cellist.hpp>

#include "command_line.hpp"
#include "files.hpp"
#include "image.hpp"
#include "image_difference.hpp"
#include "json_report.hpp"
#include "measure.hpp"
#include "options.hpp"
#include "page.hpp"
#include "report.hpp"

namespace {

using motion::Measurement;
using motion::Options;
using motion::Report;

// The name of a picture of a method, where there are several.
std::filesystem::path path_for(const std::filesystem::path& path, const Options& options,
                               const Measurement& measurement) {
    if (path.empty() || options.method != "all" || support::is_standard_output(path)) return path;
    return std::filesystem::path(path).replace_filename(
        path.stem().string() + "-" + std::string(measurement.method) + path.extension().string());
}

std::vector<cl_float4> shadow_picture(const std::vector<cl_float4>& picture) {
    std::vector<cl_float4> parts;
    for (const cl_float4& pixel : picture)
        parts.push_back({{pixel.s[3], pixel.s[3], pixel.s[3], 1}});
    return parts;
}

void write_pictures(const Report& report, std::ostream& screen) {
    const Options& options = report.options;
    const int width = options.settings.width, height = options.settings.height;
    const auto write = [&](const std::filesystem::path& path,
                           const std::vector<cl_float4>& picture) {
        if (path.empty()) return;
        support::write_image(path, picture, width, height);
        screen << "written " << support::text_of(path) << '\n';
    };
    const Measurement* reference = report.reference();
    if (reference != nullptr) write(options.out_reference, reference->picture);
    if (options.trade) return;
    for (const Measurement& m : report.measurements) {
        if (!options.shows(m.method)) continue;
        write(path_for(options.out, options, m), m.picture);
        if (!options.out_shadow.empty())
            write(path_for(options.out_shadow, options, m), shadow_picture(m.picture));
        if (options.out_difference.empty() || !m.comparison) continue;
        const std::filesystem::path difference = path_for(options.out_difference, options, m);
        support::write_difference(difference, m.picture, reference->picture, width, height);
        screen << "written " << support::text_of(difference) << '\n';
    }
}

bool run(const Options& options) {
    std::ostream& screen = options.writes_to_stdout() ? std::cerr : std::cout;
    const cellist::Device device = options.device.empty() ? cellist::Device::choose()
                                                          : cellist::Device::choose(options.device);
    const motion::Scene scene = make_scene(options);
    Report report;
    report.options = options;
    report.device = device.info().name;
    report.driver = device.info().driver;
    report.triangles = scene.triangles.size();
    report.measurements = motion::measure(device, scene, options);
    report.paper = motion::paper_size(device, scene, options);
    print(screen, report);
    write_pictures(report, screen);
    const auto write = [&](const std::filesystem::path& path, const auto& text) {
        if (path.empty()) return;
        support::write_file(path, text());
        screen << "written " << support::text_of(path) << '\n';
    };
    write(options.json, [&] { return support::dump(to_json(report), 2) + '\n'; });
    write(options.html, [&] { return to_html(report); });
    write(options.csv, [&] { return to_csv(report); });
    if (options.arguments.empty())
        screen << "next: --method all compares methods, --reference measures their errors; walker, "
                  "fan, blinds\nand mesh files are other scenes\n";
    return true;
}

}  // namespace

int main(int count, char** arguments) {
    return support::run_program("cellist-motion-shadows", [&] {
        const Options options = motion::parse_options(count, arguments);
        if (options.help_text.empty()) return run(options);
        std::cout << options.help_text;
        return true;
    });
}
