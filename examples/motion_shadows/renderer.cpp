// SPDX-License-Identifier: MIT
#include "renderer.hpp"

#include <algorithm>
#include <limits>

#include "motion_kernels.hpp"

namespace motion {

Renderer::Renderer(const cellist::Device& device, const Scene& scene, const Settings& settings)
    : frame_(device, scene, settings),
      sweep_(device, kernels::sweep_camera_cl),
      make_receivers_(moving_kernel(device, with_receivers(kernels::visible_cl), "make_receivers")),
      add_samples_(moving_kernel(device, with_receivers(kernels::shade_cl), "add_samples")),
      finish_(moving_kernel(device, with_receivers(kernels::shade_cl), "finish_picture")),
      sums_(device, frame_.pixels()),
      picture_(device, frame_.pixels()) {}

Sampling Renderer::batch(cl_uint first) const {
    const cl_uint samples = frame_.settings.samples;
    return {samples, first, std::min<cl_uint>(samples - first, batch_samples)};
}

void Renderer::find_visible(const Sampling& batch) {
    Frame& f = frame_;
    f.keys.fill(no_key);
    sweep_.run(f.scene, f.camera, f.keys, batch);
    make_receivers_.run(cellist::Range{f.pixels(), batch.count}, f.camera.view, f.camera.vertices,
                        f.light.view, f.light.vertices, f.scene.indices, f.scene.begin, f.scene.end,
                        f.shading, batch, f.keys, f.receivers, f.farthest);
}

void Renderer::draw(ShadowMethod& method, support::PassTimes* times) {
    const auto end = [&](const char* pass) {
        if (times != nullptr) times->end(pass);
    };
    const cl_uint samples = frame_.settings.samples;
    const auto pixels = static_cast<cl_uint>(frame_.pixels());
    if (samples == 0) {
        picture_.fill(cl_float4{{0, 0, 0, 0}});
        return;
    }
    frame_.project();
    end("project");
    frame_.farthest.fill(frame_.settings.prepass ? 0.0F
                                                 : std::numeric_limits<cl_float>::infinity());
    // The shadow map is for the receivers of all batches.
    const bool is_one_batch = samples <= batch_samples;
    if (frame_.settings.prepass || is_one_batch)
        for (cl_uint first = 0; first < samples; first += batch_samples) find_visible(batch(first));
    end("visible");
    for (cl_uint first = 0; first < samples; first += batch_samples) {
        if (!is_one_batch) {
            find_visible(batch(first));
            end("visible");
        }
        method.mark_shadows(frame_, batch(first), times);
        add_samples_.run(cellist::Range::padded(pixels, 64), frame_.shading, batch(first),
                         frame_.receivers, frame_.scene.albedos, pixels, sums_);
        end("shade");
    }
    finish_.run(cellist::Range::padded(pixels, 64), sums_, pixels, samples, picture_);
    end("shade");
}

}  // namespace motion
