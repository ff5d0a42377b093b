#include "renderer.hpp"

#include <algorithm>

#include "motion_kernels.hpp"

namespace motion {

Renderer::Renderer(const cellist::Device& device, const Scene& scene, const Settings& settings)
    : frame_(device, scene, settings),
      candidates_(device,
                  {static_cast<std::size_t>(settings.width),
                   static_cast<std::size_t>(settings.height)},
                  {.storage = settings.storage}),
      sweep_(device, kernels::sweep_candidates_cl, candidates_),
      project_(moving_kernel(device, kernels::project_cl, "project_vertices")),
      find_visible_(moving_kernel(device, kernels::visible_cl, "find_visible", candidates_)),
      mark_wanted_(device, kernels::shade_cl, "mark_wanted"),
      add_samples_(device, kernels::shade_cl, "add_samples"),
      finish_(moving_kernel(device, kernels::finish_cl, "finish_picture")),
      sums_(device, frame_.pixels()),
      picture_(device, frame_.pixels()) {}

Sampling Renderer::batch(cl_uint first) const {
    const cl_uint samples = frame_.settings.samples;
    return {samples, first, std::min<cl_uint>(samples - first, batch_samples)};
}

void Renderer::project() {
    const SceneBuffers& scene = frame_.scene;
    for (const SeenScene* seen : {&frame_.camera, &frame_.light})
        project_.run(cellist::Range::padded(scene.vertex_count, 64), seen->view, scene.begin,
                     scene.end, scene.vertex_count, seen->vertices);
}

void Renderer::find_visible(const Sampling& batch) {
    find_visible_.run(cellist::Range::padded(frame_.pixels(), 64), candidates_, frame_.camera.view,
                      frame_.camera.vertices, frame_.scene.indices, batch, frame_.hits);
}

void Renderer::draw(ShadowMethod& method, support::PassTimes* times) {
    const auto end = [&](const char* pass) {
        if (times != nullptr) times->end(pass);
    };
    const cl_uint samples = frame_.settings.samples;
    project();
    end("project");
    report_ = candidates_.build([&] { sweep_.run(frame_.scene, frame_.camera, candidates_); });
    end("candidates");
    const bool needs_prepass = frame_.settings.prepass;
    const bool is_one_batch = samples <= batch_samples;
    frame_.wanted.fill(static_cast<cl_uchar>(needs_prepass ? 0 : 1));
    for (cl_uint first = 0; first < samples; first += batch_samples) {
        if (!needs_prepass && !is_one_batch) break;
        find_visible(batch(first));
        end("visible");
        if (!needs_prepass) continue;
        mark_wanted_.run(frame_, cellist::Range{frame_.pixels(), batch(first).count}, std::tie(),
                         batch(first), frame_.hits, frame_.wanted);
        end("prepass");
    }
    for (cl_uint first = 0; first < samples; first += batch_samples) {
        if (!is_one_batch) {
            find_visible(batch(first));
            end("visible");
        }
        method.mark_shadows(frame_, batch(first), times);
        add_samples_.run(frame_, cellist::Range::padded(frame_.pixels(), 64), std::tie(),
                         batch(first), frame_.hits, frame_.scene.albedos, sums_);
        end("shade");
    }
    finish_.run(cellist::Range::padded(frame_.pixels(), 64), sums_,
                static_cast<cl_uint>(frame_.pixels()), samples, picture_);
    end("shade");
}

}  // namespace motion
