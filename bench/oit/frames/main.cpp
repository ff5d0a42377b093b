// SPDX-License-Identifier: MIT
// Measures speed and accuracy of transparency for docs/transparency-results.md. CELLIST_DEVICE
// names the device.

#include <iostream>
#include <thread>

#include "command_line.hpp"
#include "files.hpp"
#include "number_text.hpp"
#include "oit/frames/run.hpp"

namespace {

struct Options : bench::RunOptions {
    std::filesystem::path json = {};
    std::string git = "unknown";
    std::string help_text = {};
};

Options parse(int count, const char* const* arguments) {
    Options options;
    support::CommandLine line("cellist-oit-frames",
                              "Measures the times of whole frames, exact methods, fewer layers and "
                              "plain C++, and the accuracy of all layers.");
    line.add_text("--meshes", options.meshes, "folder with teapot.obj and dragon.ply", "FOLDER");
    line.add_text("--json", options.json, "write the metrics to this file", "FILE");
    line.add_text("--git", options.git, "the commit to record in the results", "HASH");
    line.add_text("--filter", options.filter,
                  "run only what matches this regular expression: SECTION/CASE", "RE");
    line.add("--size", support::shortest(options.size), "factor for the sides of all images", "F",
             [&](const std::string& text) {
                 options.size =
                     support::read_between("--size", text, 1e-3, 8, "a number from 0.001 to 8");
             });
    line.add_number("--frames", options.frames, 1, 1'000'000,
                    "timed frames of each kind, after a warm-up");
    line.add_check([&] {
        if (!options.json.empty()) support::check_output_path(options.json);
    });
    line.add_footer("Sections: frame_times, exact_methods, fewer_layers, plain_cpp, accuracy\n");
    options.help_text = line.parse(count, arguments).value_or("");
    return options;
}

void run(const Options& options) {
    const cellist::Device device = cellist::Device::choose();
    bench::Run run(device, options);
    measure_frame_times(run);
    measure_exact_methods(run);
    measure_fewer_layers(run);
    measure_plain_cpp(run);
    measure_accuracy(run);

    const cellist::DeviceInfo& info = device.info();
    const bool gpu = info.is_gpu();
    bench::Run::Row results{
        {"device", info.name},
        {"platform", info.platform},
        {"driver", info.driver},
        {"kind", gpu ? "gpu" : "cpu"},
        {"threads", gpu ? std::thread::hardware_concurrency() : info.compute_units},
        {"git", options.git},
        {"size", options.size}};
    results.update(run.rows());
    if (options.json.empty()) {
        std::cout << results.dump(1) << '\n';
        return;
    }
    support::write_file(options.json, results.dump(1) + '\n');
}

}  // namespace

int main(int count, char** arguments) {
    return support::run_program("cellist-oit-frames", [&] {
        const Options options = parse(count, arguments);
        if (!options.help_text.empty())
            std::cout << options.help_text;
        else
            run(options);
        return true;
    });
}
