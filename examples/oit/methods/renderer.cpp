// SPDX-License-Identifier: MIT
#include "methods/renderer.hpp"

#include "input_error.hpp"
#include "stopwatch.hpp"

namespace oit {
namespace {

std::unique_ptr<Method> make_method(FragmentSource& source, const MethodInfo& info) {
    const std::string refusal = info.refusal(source.frame(), source.features());
    if (!refusal.empty())
        throw support::InputError("the method " + std::string(info.name) +
                                  " cannot draw this: " + refusal);
    return info.make(source);
}

void check_memory(const Method& method, const std::optional<std::uint64_t>& most) {
    if (most && method.device_bytes() > *most)
        throw support::InputError("the method takes " + std::to_string(method.device_bytes()) +
                                  " bytes, over the " + std::to_string(*most) +
                                  " of --memory: raise the limit, or use a method that draws lists "
                                  "in slices");
}

std::unique_ptr<Reduction> make_reduction(const cellist::Device& device, const Frame& frame) {
    return frame.quality.reduce > 1 ? std::make_unique<Reduction>(device, frame) : nullptr;
}

std::unique_ptr<LensFrame> make_lens_frame(const cellist::Device& device, const Frame& frame,
                                           const MethodInfo& method) {
    return frame.lens && !method.draws_views ? std::make_unique<LensFrame>(device, frame) : nullptr;
}

}  // namespace

Renderer::Renderer(const cellist::Device& device, const Frame& frame, const MethodInfo& method)
    : device_(device),
      lens_(make_lens_frame(device, frame, method)),
      reduction_(make_reduction(device, frame)),
      source_(device, drawn(frame)),
      method_(make_method(source_, method)) {}

const Frame& Renderer::drawn(const Frame& frame) const {
    if (lens_) return lens_->widened();
    return reduction_ ? reduction_->reduced() : frame;
}

void Renderer::start(const AfterPass& after_pass) {
    if (reduction_) reduction_->transform();
    source_.projection().transform();
    after_pass(&PassTimes::transform_ms);

    if (reduction_) reduction_->draw_opaque(source_);
    source_.prepare();
    method_->draw([&] {
        check_memory(*method_, source_.frame().memory_bytes);
        after_pass(&PassTimes::raster_insert_ms);
    });
    source_.average_samples();
    if (reduction_) reduction_->enlarge(source_);
    if (lens_) lens_->cut_out(source_);
    after_pass(&PassTimes::sort_blend_ms);

    // The last command: the image is there when the counts are.
    source_.read_counts();
    device_.queue().flush();
}

bool Renderer::finish_or_grow() {
    const bool drawn = source_.finish_or_grow();
    return method_->finish_or_grow() && drawn;
}

void Renderer::warm_up() {
    // The first frame finds out how much room the second makes.
    draw();
    draw();
}

double Renderer::draw() {
    device_.finish();
    const support::Stopwatch stopwatch;
    start();
    finish();
    return stopwatch.ms();
}

void Renderer::finish() {
    while (!finish_or_grow()) start();
}

double Renderer::draw_changed() {
    if (lens_) lens_->follow();
    if (reduction_) reduction_->follow();
    source_.follow();
    return draw();
}

std::vector<PixelFragment> Renderer::fragments_at(int x, int y, std::size_t eye) {
    const Frame& drawn = drawn_frame();
    const auto place = [&](int i) {
        return static_cast<std::size_t>(i / drawn.quality.reduce + drawn.margin);
    };
    const auto width = static_cast<std::size_t>(drawn.width());
    const auto height = static_cast<std::size_t>(drawn.height());
    return pixel_list(source_, (eye * height + place(y)) * width + place(x));
}

PassTimes Renderer::draw_by_pass() {
    PassTimes times;
    do {
        device_.finish();
        support::Stopwatch stopwatch;
        start([&](double PassTimes::*pass) {
            device_.finish();
            times.*pass = stopwatch.ms();
            stopwatch = {};
        });
    } while (!finish_or_grow());
    return times;
}

}  // namespace oit
