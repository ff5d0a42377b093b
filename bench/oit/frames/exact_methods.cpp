// SPDX-License-Identifier: MIT
// Every exact method against linked lists, with all layers and the same rasteriser: Table 1 of Yang
// et al. 2010.

#include <array>
#include <memory>

#include "budget/setting.hpp"
#include "methods/method.hpp"
#include "methods/renderer.hpp"
#include "oit/frames/run.hpp"

namespace bench {
namespace {

struct Contender {
    const oit::MethodInfo* method;
    std::unique_ptr<oit::Renderer> renderer;
};

// The methods that draw the frame on this device.
std::vector<Contender> contenders(Run& run, const Stage& stage) {
    std::vector<Contender> result;
    for (const oit::MethodInfo& method : oit::methods()) {
        if (!method.exact) continue;
        try {
            auto renderer = std::make_unique<oit::Renderer>(run.device(), stage.frame, method);
            renderer->warm_up();
            result.push_back({&method, std::move(renderer)});
        } catch (const std::exception& error) {
            run.leave_out("exact_methods/" + std::string(method.name), error.what());
        }
    }
    return result;
}

}  // namespace

void measure_exact_methods(Run& run) {
    const std::array cases{mesh_case("teapot.obj"), mesh_case("dragon.ply")};
    run.measure("exact_methods", cases, [&](const Stage& stage) {
        const std::vector<Contender> all = contenders(run, stage);
        std::vector<std::function<double()>> drawings;
        for (const Contender& contender : all)
            drawings.emplace_back([&] { return contender.renderer->draw(); });
        const std::vector<Samples> times = run.draw_interleaved(drawings);

        const oit::MethodInfo* const linked = oit::exact_setting(stage.frame.quality).method;
        double linked_time = 0;
        for (std::size_t i = 0; i < all.size(); ++i)
            if (all[i].method == linked) linked_time = times[i].median;
        std::vector<Run::Row> rows;
        for (std::size_t i = 0; i < all.size(); ++i) {
            Run::Row row{{"method", all[i].method->name},
                         {"times_linked", times[i].median / linked_time}};
            row.update(to_json(times[i]));
            rows.push_back(std::move(row));
        }
        return rows;
    });
}

}  // namespace bench
