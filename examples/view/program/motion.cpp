// SPDX-License-Identifier: MIT
// Motion-blurred shadows: cellist-motion-shadows.
#include <algorithm>
#include <memory>

#include "accumulate.hpp"
#include "input_error.hpp"
#include "measure.hpp"
#include "number_text.hpp"
#include "options.hpp"
#include "program/program.hpp"
#include "program/scene_cache.hpp"
#include "stopwatch.hpp"

namespace viewer {
namespace {

constexpr std::string_view motion_command = "cellist-motion-shadows";

const motion::NamedMethod& motion_method(const std::string& name) {
    const auto method = std::ranges::find(motion::methods, name, &motion::NamedMethod::name);
    if (method == motion::methods.end())
        throw support::InputError("--method " + name + " is no single method: choose one");
    return *method;
}

SceneCache<motion::Scene>& loaded_motion_scenes() {
    static SceneCache<motion::Scene> scenes;
    return scenes;
}

class MotionInstrument : public Instrument {
public:
    explicit MotionInstrument(const Studio& studio) : studio_(studio) {}

    PictureInfo draw(const Arguments& arguments) override {
        const motion::Options options =
            parse_with(arguments, motion_command, motion::parse_options);
        if (!has_image() || arguments != arguments_) {
            release();
            scene_ = loaded_motion_scenes().get(scene_key(arguments),
                                                [&] { return make_scene(options); });
            settings_ = options.settings;
            arguments_ = arguments;
        }
        PictureInfo info{.orbit = support::orbit_of(scene_->eye, scene_->target)};
        info.orbit.zoom = options.zoom;
        info.facts = {{"triangles", support::grouped(scene_->triangles.size())}};
        const motion::NamedMethod& method = motion_method(options.method);
        if (method.make == nullptr) {
            info.frame_ms = support::measure_ms(studio_.device, [&] { draw_reference(options); });
            return info;
        }
        if (!renderer_) {
            renderer_ = std::make_unique<motion::Renderer>(studio_.device, *scene_, settings_);
            method_ = method.make(renderer_->frame());
        }
        info.frame_ms = support::measure_ms(studio_.device, [&] { renderer_->draw(*method_); });
        const motion::ShadowMapSize map = method_->size();
        info.facts.emplace_back("ranges", support::grouped(map.ranges));
        info.facts.emplace_back("shadow map", support::megabytes(map.bytes) + " MB");
        return info;
    }

    [[nodiscard]] std::pair<int, int> size() const override {
        return {settings_.width, settings_.height};
    }
    [[nodiscard]] const cellist::Buffer<cl_float4>& image() const override {
        return reference_ ? *reference_ : renderer_->picture();
    }

private:
    static std::string scene_key(const Arguments& arguments) {
        Arguments key;
        key.scene = arguments.scene;
        for (const char* option :
             {"--triangles", "--move", "--spin", "--exposure", "--light", "--view", "--zoom"})
            if (arguments.has(option)) key.set(option, arguments.get(option));
        return key.command_line("");
    }

    [[nodiscard]] bool has_image() const { return renderer_ || reference_; }

    void release() {
        method_.reset();
        renderer_.reset();
        reference_.reset();
    }

    void draw_reference(const motion::Options& options) {
        if (reference_) return;
        motion::Settings settings = settings_;
        settings.samples = 1;
        motion::Frame frame(studio_.device, *scene_, settings);
        motion::Accumulation accumulation(frame);
        // Few at a time, so that the work can end early.
        constexpr cl_uint step = 8;
        for (cl_uint first = 0; first < options.moments; first += step) {
            accumulation.draw(first, std::min(step, options.moments - first), options.moments);
            studio_.device.finish();
            studio_.progress(static_cast<double>(first) / options.moments);
        }
        reference_.emplace(studio_.device, accumulation.picture(options.moments));
    }

    const Studio& studio_;
    Arguments arguments_;
    motion::Settings settings_;
    std::shared_ptr<const motion::Scene> scene_;
    std::unique_ptr<motion::Renderer> renderer_;
    std::unique_ptr<motion::ShadowMethod> method_;
    std::optional<cellist::Buffer<cl_float4>> reference_;
};

std::vector<Control> motion_controls() {
    using enum Control::Kind;
    std::vector<std::string> methods;
    for (const motion::NamedMethod& method : motion::methods) methods.emplace_back(method.name);
    std::vector<Control> controls{
        {.kind = choice,
         .option = "--method",
         .label = "method",
         .usual = "exact",
         .hint = "method of the shadows; accumulate is the reference",
         .choices = methods,
         .splits = true},
        {.kind = choice,
         .option = "--samples",
         .label = "samples",
         .usual = "20",
         .hint = "samples of each pixel, each at its own time",
         .choices = {"4", "8", "16", "20", "32", "64"},
         .splits = true},
        {.kind = choice,
         .option = "--times",
         .label = "moments",
         .usual = "3000",
         .hint = "moments of accumulate",
         .choices = {"16", "64", "256", "1000", "3000"},
         .splits = true,
         .needs = {"--method", "accumulate"}},
        {.kind = choice,
         .option = "--shadow-map",
         .label = "map",
         .usual = "1024",
         .hint = "texels of the shadow map along each axis",
         .choices = {"256", "512", "1024", "2048"},
         .splits = true},
        {.kind = choice,
         .option = "--light",
         .label = "light",
         .usual = "spot",
         .choices = {"spot", "directional"}},
        {.kind = number,
         .option = "--exposure",
         .label = "exposure",
         .usual = "1",
         .hint = "scale the motion: 0 stops it",
         .most = 4},
    };
    for (const char* option :
         {"--triangles", "--move", "--spin", "--width", "--height", "--bias", "--prepass",
          "--insides", "--compress", "--tolerance", "--memory", "--storage"})
        controls.push_back({.option = option});
    add_common_controls(controls);
    return controls;
}

}  // namespace

Program make_motion_program() {
    return {.name = "motion-shadows",
            .command = std::string(motion_command),
            .title = "motion blur",
            .scenes = {"cubes", "walker", "fan", "blinds"},
            .controls = motion_controls(),
            .scene_options = {"--triangles", "--move", "--spin", "--view", "--zoom"},
            .set_size = set_width_and_height,
            .make = [](const Studio& studio) -> std::unique_ptr<Instrument> {
                return std::make_unique<MotionInstrument>(studio);
            }};
}

}  // namespace viewer
