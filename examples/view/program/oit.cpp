// SPDX-License-Identifier: MIT
// Order-independent transparency: cellist-oit.
#include <memory>

#include "budget/budget_controller.hpp"
#include "methods/renderer.hpp"
#include "number_text.hpp"
#include "options.hpp"
#include "program/program.hpp"
#include "program/scene_cache.hpp"
#include "scene/scenes.hpp"

namespace viewer {
namespace {

constexpr std::string_view oit_command = "cellist-oit";

std::string blend_name(cl_uint blend) {
    constexpr const char* names[] = {"opaque", "over",     "additive", "multiplicative",
                                     "absorb", "function", "leave"};
    return blend < std::size(names) ? names[blend] : "";
}

// The parts of a scene's command line that change the scene itself.
std::string scene_key(const Arguments& arguments) {
    Arguments key;
    key.scene = arguments.scene;
    for (const char* option : {"--alpha", "--up", "--blend"})
        if (arguments.has(option)) key.set(option, arguments.get(option));
    return key.command_line("");
}

SceneCache<oit::Scene>& loaded_scenes() {
    static SceneCache<oit::Scene> scenes;
    return scenes;
}

class OitInstrument : public Instrument {
public:
    explicit OitInstrument(const Studio& studio) : studio_(studio) {}

    PictureInfo draw(const Arguments& arguments) override {
        const oit::Options options = parse_with(arguments, oit_command, oit::parse_options);
        oit::check_size(options, studio_.device);
        const Arguments fixed = arguments.without({"--view", "--zoom", "--time"});
        const auto base = loaded_scenes().get(scene_key(arguments), [&] {
            oit::FrameOptions still = options;
            still.time = 0;
            return oit::make_scene(still);
        });
        if (options.time != 0) oit::require_motion(*base, options, "--time");
        const bool has_floor = oit::sees_floor(*base, options);
        PictureInfo info{.moves = oit::moves(*base), .orbit = options.orbit};
        if (is_ready() && fixed == fixed_ && base == base_ && has_floor == has_floor_) {
            frame_->views = oit::make_views(options);
            frame_->time = options.time;
            info.frame_ms = draw_again();
        } else {
            release();
            base_ = base;
            fixed_ = fixed;
            has_floor_ = has_floor;
            make_frame(options);
            info.frame_ms = draw_first(options);
        }
        describe(info, options);
        return info;
    }

    [[nodiscard]] std::pair<int, int> size() const override {
        return {frame_->width(), frame_->height()};
    }
    [[nodiscard]] std::size_t eyes() const override { return frame_->views.size(); }
    [[nodiscard]] const cellist::Buffer<cl_float4>& image() const override {
        return renderer().picture();
    }

    [[nodiscard]] std::optional<PixelCounts> list_lengths() override {
        const oit::Frame& drawn = renderer().drawn_frame();
        const std::vector<cl_uint> layers = renderer().layers();
        // The frame that was drawn may be smaller than the image, or have a margin.
        PixelCounts counts{{}, "layers"};
        const auto width = static_cast<std::size_t>(drawn.width());
        const auto height = static_cast<std::size_t>(drawn.height());
        for (std::size_t eye = 0; eye < eyes(); ++eye)
            for (int y = 0; y < frame_->height(); ++y)
                for (int x = 0; x < frame_->width(); ++x) {
                    const auto place = [&](int i) {
                        return static_cast<std::size_t>(i / drawn.quality.reduce + drawn.margin);
                    };
                    counts.counts.push_back(layers[(eye * height + place(y)) * width + place(x)]);
                }
        return counts;
    }

    [[nodiscard]] std::optional<std::vector<ListEntry>> list_at(int x, int y,
                                                                std::size_t eye) override {
        std::vector<ListEntry> list;
        for (const oit::PixelFragment& fragment : renderer().fragments_at(x, y, eye)) {
            ListEntry entry{.depth = static_cast<double>(fragment.depth),
                            .alpha = static_cast<double>(fragment.alpha),
                            .coverage = fragment.coverage,
                            .blend = blend_name(fragment.blend)};
            std::ranges::copy(fragment.colour, entry.colour);
            list.push_back(std::move(entry));
        }
        return list;
    }

private:
    [[nodiscard]] bool is_ready() const { return renderer_ || controller_; }
    [[nodiscard]] oit::Renderer& renderer() const {
        return controller_ ? controller_->renderer() : *renderer_;
    }

    void release() {
        renderer_.reset();
        controller_.reset();
        frame_.reset();
        floored_.reset();
    }

    void make_frame(const oit::Options& options) {
        if (has_floor_) {
            floored_ = std::make_unique<oit::Scene>(*base_);
            oit::add_floor(*floored_);
        }
        frame_ =
            std::make_unique<oit::Frame>(oit::make_frame(has_floor_ ? *floored_ : *base_, options));
        frame_->memory_bytes = options.memory_bytes;
    }

    double draw_first(const oit::Options& options) {
        if (!options.budget) {
            renderer_ = std::make_unique<oit::Renderer>(studio_.device, *frame_,
                                                        oit::method_named(options.method));
            return guarded([&] { return renderer_->draw(); });
        }
        return guarded([&] {
            controller_ = std::make_unique<oit::BudgetController>(
                studio_.device, *frame_, *options.budget, options.check_every,
                oit::SearchOptions{.progress = studio_.progress,
                                   .seconds = options.search_seconds});
            return controller_->draw().frame_ms;
        });
    }

    double draw_again() {
        return guarded(
            [&] { return controller_ ? controller_->draw().frame_ms : renderer_->draw_changed(); });
    }

    // A renderer that failed is not used again.
    double guarded(const auto& draw) {
        try {
            return draw();
        } catch (...) {
            release();
            throw;
        }
    }

    void describe(PictureInfo& info, const oit::Options& options) const {
        const auto add = [&](const char* name, std::string text) {
            info.facts.emplace_back(name, std::move(text));
        };
        add("triangles", support::grouped(frame_->scene.triangles()));
        add("memory", support::megabytes(renderer().device_bytes()) + " MB");
        if (!controller_) return;
        const oit::Choice& choice = controller_->choice();
        add("chosen", text(choice.setting));
        add("error", std::string(choice.met ? "at most " : "not met: ") +
                         options.budget->text_of(options.budget->counted(choice.errors)));
    }

    const Studio& studio_;
    Arguments fixed_;  // without what changes from frame to frame
    std::shared_ptr<const oit::Scene> base_;
    bool has_floor_ = false;
    std::unique_ptr<oit::Scene> floored_;
    std::unique_ptr<oit::Frame> frame_;
    std::unique_ptr<oit::Renderer> renderer_;
    std::unique_ptr<oit::BudgetController> controller_;  // in place of renderer_, within a budget
};

std::vector<std::string> method_choices() {
    std::vector<std::string> choices;
    for (const oit::MethodInfo& method : oit::methods()) {
        choices.emplace_back(method.name);
        for (const std::uint32_t size : method.sizes)
            choices.push_back(std::string(method.name) + ":" + std::to_string(size));
    }
    return choices;
}

std::vector<std::string> format_choices() {
    std::vector<std::string> choices;
    for (const oit::NodeFormatName& format : oit::node_formats) choices.emplace_back(format.name);
    return choices;
}

std::vector<Control> oit_controls() {
    using enum Control::Kind;
    std::vector<Control> controls{
        {.kind = choice,
         .option = "--method",
         .label = "method",
         .usual = "linked",
         .hint = "transparency method, and its size",
         .choices = method_choices(),
         .splits = true},
        {.kind = choice,
         .option = "--layers",
         .label = "layers",
         .usual = "all",
         .hint = "nearest layers to blend",
         .choices = {"all", "1", "2", "4", "8", "16", "32", "64"},
         .splits = true},
        {.kind = choice,
         .option = "--samples",
         .label = "samples",
         .usual = "1",
         .hint = "samples per pixel, or the exact area that each triangle covers",
         .choices = {"1", "2", "4", "8", "exact"},
         .splits = true},
        {.kind = choice,
         .option = "--format",
         .label = "format",
         .usual = "float",
         .hint = "format of colour and depth in a fragment",
         .choices = format_choices(),
         .splits = true},
        {.kind = choice,
         .option = "--reduce",
         .label = "reduce",
         .usual = "1",
         .hint = "draw transparent surfaces with 1/N of the width and height",
         .choices = {"1", "2", "4"},
         .splits = true},
        {.kind = choice,
         .option = "--budget",
         .label = "budget",
         .usual = "none",
         .hint = "find the cheapest setting within this error",
         .choices = {"none", "30dB", "40dB", "50dB", "4/255", "1/255"},
         .splits = true,
         .replaces = {"--method", "--layers", "--epsilon", "--format", "--reduce", "--memory"}},
        {.kind = number,
         .option = "--alpha",
         .label = "opacity",
         .usual = "0.35",
         .hint = "opacity of surfaces whose file gives none"},
        {.kind = flag,
         .option = "--opaque-floor",
         .label = "floor",
         .hint = "stand the scene on an opaque floor"},
    };
    for (const char* option :
         {"--size", "--up", "--blend", "--resolve", "--depth-scale", "--stereo", "--lens",
          "--lens-rays", "--time", "--epsilon", "--memory", "--check-every", "--search-seconds"})
        controls.push_back({.option = option});
    for (const char* option : {"--depth-range", "--strict"})
        controls.push_back({.kind = flag, .option = option});
    add_common_controls(controls);
    return controls;
}

}  // namespace

Program make_oit_program() {
    std::vector<std::string> scenes;
    for (const oit::SceneInfo& scene : oit::scenes()) scenes.emplace_back(scene.name);
    return {.name = "oit",
            .command = std::string(oit_command),
            .title = "transparency",
            .scenes = scenes,
            .controls = oit_controls(),
            .time_option = "--time",
            .scene_options = {"--alpha", "--up", "--time"},
            .set_size =
                [](Arguments& arguments, int width, int height) {
                    arguments.set("--size", std::to_string(width) + "x" + std::to_string(height));
                },
            .make = [](const Studio& studio) -> std::unique_ptr<Instrument> {
                return std::make_unique<OitInstrument>(studio);
            }};
}

}  // namespace viewer
