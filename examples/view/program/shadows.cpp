// SPDX-License-Identifier: MIT
// One-bounce indirect light with shadows: cellist-shadows.
#include <memory>

#include "camera_options.hpp"
#include "frame.hpp"
#include "number_text.hpp"
#include "options.hpp"
#include "program/program.hpp"
#include "stopwatch.hpp"

namespace viewer {
namespace {

constexpr std::string_view shadows_command = "cellist-shadows";

class ShadowsInstrument : public Instrument {
public:
    explicit ShadowsInstrument(const Studio& studio) : studio_(studio) {}

    PictureInfo draw(const Arguments& arguments) override {
        const shadows::Options options =
            parse_with(arguments, shadows_command, shadows::parse_options);
        const Arguments fixed = arguments.without({"--view", "--zoom", "--time"});
        if (!renderer_ || fixed != fixed_) {
            renderer_.reset();
            shadows::Options still = options;
            still.view.reset();
            still.zoom = 1;
            scene_ = std::make_unique<shadows::Scene>(make_scene(still));
            eye_ = scene_->eye;
            settings_ = options.settings;
            renderer_ = std::make_unique<shadows::Renderer>(studio_.device, *scene_, settings_);
            fixed_ = fixed;
        }
        scene_->eye = support::moved_eye(eye_, scene_->target, options.view, options.zoom);
        if (scene_->move)
            scene_->move(*scene_, options.time);
        else
            renderer_->follow_camera(*scene_);
        PictureInfo info{.moves = static_cast<bool>(scene_->move),
                         .orbit = support::orbit_of(scene_->eye, scene_->target)};
        info.orbit.zoom = options.zoom;
        info.frame_ms = support::measure_ms(studio_.device, [&] { renderer_->draw(*scene_); });
        const shadows::FrameCounts counts = renderer_->counts();
        info.facts = {{"triangles", support::grouped(triangle_count(*scene_))},
                      {"rays", support::grouped(counts.rays)},
                      {"blocked", support::grouped(counts.blocked)},
                      {"list entries", support::grouped(counts.build.stored)},
                      {"memory", support::megabytes(renderer_->device_bytes()) + " MB"}};
        return info;
    }

    [[nodiscard]] std::pair<int, int> size() const override {
        return {settings_.width, settings_.height};
    }
    [[nodiscard]] const cellist::Buffer<cl_float4>& image() const override {
        return renderer_->picture();
    }
    [[nodiscard]] std::optional<PixelCounts> list_lengths() override {
        return PixelCounts{renderer_->passed_entries(*scene_), "list entries"};
    }

private:
    const Studio& studio_;
    Arguments fixed_;  // without what changes from frame to frame
    shadows::Settings settings_;
    glm::dvec3 eye_{0};  // as the scene has it
    std::unique_ptr<shadows::Scene> scene_;
    std::unique_ptr<shadows::Renderer> renderer_;
};

std::vector<Control> shadows_controls() {
    using enum Control::Kind;
    std::vector<Control> controls{
        {.kind = choice,
         .option = "--samples",
         .label = "samples",
         .usual = "8",
         .hint = "parts of the shadow map along each axis that light the scene",
         .choices = {"2", "4", "8", "16", "32"},
         .splits = true},
        {.kind = choice,
         .option = "--reduce",
         .label = "reduce",
         .usual = "4",
         .hint = "draw the blocked light with 1/N of the width and height",
         .choices = {"1", "2", "4", "8"},
         .splits = true},
        {.kind = choice,
         .option = "--interleave",
         .label = "interleave",
         .usual = "2",
         .hint = "share out the samples among N x N pixels",
         .choices = {"1", "2", "4"},
         .splits = true},
        {.kind = choice,
         .option = "--grid",
         .label = "grid",
         .usual = "auto",
         .hint = "cells of the grid along its longest side",
         .choices = {"auto", "16", "32", "64", "128"},
         .splits = true},
        {.kind = choice,
         .option = "--simplify",
         .label = "simplify",
         .usual = "off",
         .hint = "merge vertices of blockers in N cells along the longest side of their mesh",
         .choices = {"off", "16", "32", "64"},
         .splits = true},
        {.kind = choice,
         .option = "--storage",
         .label = "storage",
         .usual = "linked",
         .hint = "storage of the lists",
         .choices = {"linked", "counted", "fixed"},
         .splits = true},
        {.kind = choice,
         .option = "--light",
         .label = "light",
         .usual = "spot",
         .choices = {"spot", "directional"},
         .splits = true},
    };
    for (const char* option :
         {"--triangles", "--light-position", "--width", "--height", "--rsm", "--time"})
        controls.push_back({.option = option});
    add_common_controls(controls);
    return controls;
}

}  // namespace

Program make_shadows_program() {
    return {.name = "shadows",
            .command = std::string(shadows_command),
            .title = "indirect light",
            .scenes = {"room", "swarm"},
            .controls = shadows_controls(),
            .time_option = "--time",
            .scene_options = {"--triangles", "--time", "--view", "--zoom"},
            .set_size = set_width_and_height,
            .make = [](const Studio& studio) -> std::unique_ptr<Instrument> {
                return std::make_unique<ShadowsInstrument>(studio);
            }};
}

}  // namespace viewer
