// SPDX-License-Identifier: MIT
// Whole frames with all layers in lists, from the vertices to the image on the device. First the
// host waits after each frame. Then it enqueues one frame while the device draws the other.

#include <array>

#include "methods/renderer.hpp"
#include "oit/frames/run.hpp"
#include "stopwatch.hpp"

namespace bench {
namespace {

// The time from one image to the next if two frames draw at once, each with its own memory.
Samples time_two_at_once(const Run& run, oit::Renderer& one, oit::Renderer& other) {
    const std::array renderers{&one, &other};
    std::size_t started = 0;
    renderers[started]->start();
    const std::function<double()> next = [&] {
        const support::Stopwatch stopwatch;
        const std::size_t before = started;
        started = 1 - started;
        renderers[started]->start();
        renderers[before]->finish();
        return stopwatch.ms();
    };
    const Samples times = run.draw_interleaved({&next, 1}).front();
    renderers[started]->finish();
    return times;
}

}  // namespace

void measure_frame_times(Run& run) {
    const Case dragon = mesh_case("dragon.ply");
    const std::array cases{
        mesh_case("teapot.obj"), dragon,
        with(dragon, "4 samples", [](auto& options) { options.quality.samples = 4; }),
        gearworks_of_most_layers()};
    run.measure("frame_times", cases, [&](const Stage& stage) -> std::vector<Run::Row> {
        oit::Renderer renderer(run.device(), stage.frame);
        renderer.warm_up();
        const std::function<double()> draw = [&] { return renderer.draw(); };
        Run::Row row = to_json(run.draw_interleaved({&draw, 1}).front());
        oit::Renderer other(run.device(), stage.frame);
        other.warm_up();
        row["two_at_once"] = to_json(time_two_at_once(run, renderer, other));
        if (const auto lengths = renderer.method().lengths()) {
            row["fragments"] = lengths->total;
            row["most_layers"] = lengths->longest;
        }
        return {row};
    });
}

}  // namespace bench
