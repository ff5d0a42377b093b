#include "renderer.hpp"

#include "input_error.hpp"
#include "stopwatch.hpp"

namespace oit {
namespace {

std::unique_ptr<Method> make_method(FragmentSource& source, const MethodInfo& info) {
    const std::string refusal = info.refusal(source.frame(), source.needs());
    if (!refusal.empty())
        throw support::InputError("the method " + std::string(info.name) +
                                  " cannot draw this: " + refusal);
    return info.make(source);
}

}  // namespace

Renderer::Renderer(const cellist::Device& device, const Frame& frame, const MethodInfo& method)
    : device_(device), source_(device, frame), method_(make_method(source_, method)) {}

void Renderer::store() {
    source_.prepare();
    method_->store();
}

void Renderer::resolve() {
    method_->resolve();
    source_.finish();
}

bool Renderer::complete() {
    const bool drawn = source_.complete();
    return method_->complete() && drawn;
}

double Renderer::draw() {
    device_.finish();
    const support::Stopwatch stopwatch;
    source_.transform();
    do {
        store();
        resolve();
    } while (!complete());
    device_.finish();
    return stopwatch.ms();
}

double Renderer::draw_at(double time) {
    source_.move_to(time);
    return draw();
}

double Renderer::draw_changed() {
    source_.follow();
    return draw();
}

PassTimes Renderer::draw_by_pass() {
    PassTimes times;
    const auto measure = [&](double PassTimes::*pass, auto enqueue) {
        device_.finish();
        const support::Stopwatch stopwatch;
        enqueue();
        device_.finish();
        times.*pass = stopwatch.ms();
    };
    measure(&PassTimes::transform_ms, [&] { source_.transform(); });
    do {
        measure(&PassTimes::raster_insert_ms, [&] { store(); });
        measure(&PassTimes::sort_blend_ms, [&] { resolve(); });
    } while (!complete());
    return times;
}

}  // namespace oit
