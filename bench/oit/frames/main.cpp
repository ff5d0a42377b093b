// Measures speed and accuracy of transparency for docs/transparency-results.md. CELLIST_DEVICE
// names the device.

#include <iostream>
#include <thread>

#include <CLI/CLI.hpp>

#include "command_line.hpp"
#include "files.hpp"
#include "oit/frames/run.hpp"
#include "report/number_text.hpp"

namespace {

struct Options : bench::RunOptions {
    std::filesystem::path json = {};
    std::string git = "unknown";
    std::string help_text = {};
};

Options parse(int count, const char* const* arguments) {
    Options options;
    std::string size = oit::shortest(options.size), frames = std::to_string(options.frames), meshes,
                json;
    CLI::App app{
        "Measures the times of whole frames, exact methods, fewer layers and plain C++, and the "
        "accuracy of all layers.",
        "cellist-oit-frames"};
    oit::add_option(app, "--meshes", meshes, "folder with teapot.obj and dragon.ply", "FOLDER");
    oit::add_option(app, "--json", json, "write the metrics to this file", "FILE");
    oit::add_option(app, "--git", options.git, "the commit to record in the results", "HASH");
    oit::add_option(app, "--filter", options.filter,
                    "run only what matches this regular expression: SECTION/CASE", "RE");
    oit::add_option(app, "--size", size, "factor for the sides of all images", "F");
    oit::add_option(app, "--frames", frames, "timed frames of each kind, after a warm-up", "N");
    app.footer("Sections: frame_times, exact_methods, fewer_layers, plain_cpp, accuracy\n");
    if (const auto help = support::parse_command_line(app, count, arguments)) {
        options.help_text = *help;
        return options;
    }
    options.meshes = meshes;
    options.json = json;
    if (!json.empty()) support::check_output_path(json);
    options.size = oit::read_between("--size", size, 1e-3, 8, "a number from 0.001 to 8");
    options.frames =
        static_cast<std::uint32_t>(support::read_number("--frames", frames, 1, 1'000'000));
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
    const bool gpu = (info.type & CL_DEVICE_TYPE_GPU) != 0;
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
