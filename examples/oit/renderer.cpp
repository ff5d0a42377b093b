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

void check_memory(const Method& method, const std::optional<std::uint64_t>& budget) {
    if (budget && method.device_bytes() > *budget)
        throw support::InputError(
            "the method takes " + std::to_string(method.device_bytes()) +
            " bytes, over the budget of " + std::to_string(*budget) +
            ": raise it to that, or take a method with lists, which are drawn in slices");
}

std::unique_ptr<Reduction> make_reduction(const cellist::Device& device, const Frame& frame) {
    return frame.quality.reduce > 1 ? std::make_unique<Reduction>(device, frame) : nullptr;
}

}  // namespace

Renderer::Renderer(const cellist::Device& device, const Frame& frame, const MethodInfo& method)
    : device_(device),
      reduction_(make_reduction(device, frame)),
      source_(device, reduction_ ? reduction_->reduced() : frame),
      method_(make_method(source_, method)) {}

PassTimes Renderer::draw() {
    device_.finish();
    const support::Stopwatch stopwatch;
    if (reduction_) reduction_->transform();
    source_.transform();
    device_.finish();
    const double transformed = stopwatch.ms();
    if (reduction_) reduction_->prepare(source_);
    source_.prepare();
    method_->store();
    check_memory(*method_, source_.frame().memory_bytes);
    device_.finish();
    const double stored = stopwatch.ms();
    method_->resolve();
    source_.finish();
    if (reduction_) reduction_->finish(source_);
    device_.finish();
    const double end = stopwatch.ms();
    return {transformed, stored - transformed, end - stored, end};
}

PassTimes Renderer::draw_at(double time) {
    if (reduction_) reduction_->move_to(time);
    source_.move_to(time);
    return draw();
}

}  // namespace oit
