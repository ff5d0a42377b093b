// One-bounce indirect light with shadows from a grid of triangle lists.
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include <cellist/cellist.hpp>

#include "command_line.hpp"
#include "files.hpp"
#include "frame.hpp"
#include "image.hpp"
#include "mesh.hpp"
#include "scene.hpp"
#include "stopwatch.hpp"

namespace {

struct Options {
    std::filesystem::path out = "shadows.png";
    shadows::Settings settings;
    std::size_t frames = 1;
    std::string scene = "room";
    std::string device;
};

bool run(const Options& options) {
    const cellist::Device device = options.device.empty() ? cellist::Device::choose()
                                                          : cellist::Device::choose(options.device);
    shadows::Scene scene = options.scene == "room" ? shadows::make_room()
                           : options.scene == "swarm"
                               ? shadows::make_swarm(100'000)
                               : shadows::make_mesh_room(support::load_mesh(options.scene));
    shadows::Renderer renderer(device, scene, options.settings);
    renderer.draw(scene);
    support::Least least;
    for (std::size_t i = 0; i < options.frames; ++i) {
        if (scene.move) scene.move(scene, 0.02 * double(i));
        least.add(support::measure_ms(device, [&] { renderer.draw(scene); }));
    }
    shadows::PassTimes times(device);
    renderer.draw(scene, &times);
    const auto counts = renderer.counts();
    std::printf("%s: frame %.3f ms, %llu rays, %llu blocked, %llu triangles, %llu entries\n",
                device.info().name.c_str(), least.ms(),
                static_cast<unsigned long long>(counts.rays),
                static_cast<unsigned long long>(counts.blocked),
                static_cast<unsigned long long>(renderer.grid().triangles().size()),
                static_cast<unsigned long long>(counts.build.stored));
    for (const auto& [pass, ms] : times.all()) std::printf("  %-12s %8.3f ms\n", pass.c_str(), ms);
    support::write_image(options.out, renderer.picture().download(), options.settings.width,
                         options.settings.height);
    support::write_image("unblocked.png", renderer.unblocked().download(), options.settings.width,
                         options.settings.height);
    support::write_image("a.png", renderer.a().download(), options.settings.width,
                         options.settings.height);
    support::write_image("b.png", renderer.b().download(), renderer.b_width(), renderer.b_height());
    support::write_image("blurred.png", renderer.blurred_b().download(), options.settings.width,
                         options.settings.height);
    return true;
}

}  // namespace

int main(int count, char** arguments) {
    return support::run_program("cellist-shadows", [&] {
        Options options;
        if (count > 1) options.scene = arguments[1];
        if (count > 2) options.frames = std::stoul(arguments[2]);
        return run(options);
    });
}
