// SPDX-License-Identifier: MIT
#include "accumulate.hpp"

#include <cmath>

#include "motion_kernels.hpp"

namespace motion {
namespace {

// Where the picture of a moment samples its pixels: the sequence of sample_offset().
cl_float offset_of(cl_uint moment, double step) {
    const double place = 0.5 + step * moment;
    return static_cast<cl_float>(place - std::floor(place) - 0.5);
}

}  // namespace

Accumulation::Accumulation(Frame& frame)
    : frame_(frame),
      sweep_(frame.device, kernels::sweep_still_cl),
      add_moment_(moving_kernel(frame.device, with_receivers(kernels::shade_cl), "add_moment")),
      finish_(moving_kernel(frame.device, with_receivers(kernels::shade_cl), "finish_picture")),
      seen_(frame.device, frame.pixels()),
      lit_(frame.device, frame.texels()),
      sums_(frame.device, frame.pixels()),
      picture_(frame.device, frame.pixels()) {}

void Accumulation::draw(cl_uint first, cl_uint count, cl_uint moments) {
    SceneBuffers& scene = frame_.scene;
    if (first == 0) {
        sums_.fill(cl_float4{{0, 0, 0, 0}});
        frame_.project();
    }
    for (cl_uint moment = first; moment < first + count; ++moment) {
        const auto time = static_cast<cl_float>((moment + 0.5) / moments);
        const cl_float x = offset_of(moment, 0.7548776662466927);
        const cl_float y = offset_of(moment, 0.5698402909980532);
        seen_.fill(no_key);
        lit_.fill(no_key);
        sweep_.run(scene, frame_.camera, seen_, time, x, y);
        sweep_.run(scene, frame_.light, lit_, time, 0.0F, 0.0F);
        add_moment_.run(cellist::Range::padded(frame_.pixels(), 64), frame_.camera.view,
                        frame_.camera.vertices, frame_.light.view, frame_.light.vertices,
                        scene.indices, scene.begin, scene.end, frame_.shading, seen_, lit_, time, x,
                        y, scene.albedos, sums_);
    }
}

std::vector<cl_float4> Accumulation::picture(cl_uint moments) {
    finish_.run(cellist::Range::padded(frame_.pixels(), 64), sums_,
                static_cast<cl_uint>(frame_.pixels()), moments, picture_);
    return picture_.download();
}

}  // namespace motion
