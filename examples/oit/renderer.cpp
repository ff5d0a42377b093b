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

PassTimes Renderer::draw() {
    device_.finish();
    const support::Stopwatch stopwatch;
    source_.transform();
    device_.finish();
    const double transformed = stopwatch.ms();
    source_.prepare();
    method_->store();
    device_.finish();
    const double stored = stopwatch.ms();
    method_->resolve();
    source_.finish();
    device_.finish();
    const double end = stopwatch.ms();
    return {transformed, stored - transformed, end - stored, end};
}

PassTimes Renderer::draw_at(double time) {
    source_.move_to(time);
    return draw();
}

PassTimes Renderer::draw_changed() {
    source_.follow();
    return draw();
}

}  // namespace oit
