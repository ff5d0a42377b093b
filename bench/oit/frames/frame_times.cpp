// Whole frames, from the vertices to the image on the device, with a wait behind each: all layers in
// lists.

#include <array>

#include "oit/frames/run.hpp"
#include "renderer.hpp"

namespace bench {

void measure_frame_times(Run& run) {
    const Case dragon = mesh_case("dragon.ply");
    const std::array cases{
        mesh_case("teapot.obj"), dragon,
        with(dragon, "4 samples", [](auto& options) { options.quality.samples = 4; }),
        scene_case("gearworks")};
    run.measure("frame_times", cases, [&](const Stage& stage) -> std::vector<Run::Figure> {
        oit::Renderer renderer(run.device(), stage.frame);
        renderer.warm_up();
        const std::function<double()> draw = [&] { return renderer.draw(); };
        Run::Figure figure = to_json(run.draw_by_turns({&draw, 1}).front());
        if (const auto lengths = renderer.method().lengths()) {
            figure["fragments"] = lengths->total;
            figure["most_layers"] = lengths->longest;
        }
        return {figure};
    });
}

}  // namespace bench
