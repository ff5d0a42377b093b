// SPDX-License-Identifier: MIT
#include "window/panel.hpp"

#include <algorithm>
#include <array>
#include <cfloat>
#include <string>
#include <vector>

#include <imgui.h>

#include "number_text.hpp"
#include "window/control_widgets.hpp"

namespace viewer {
namespace {

const ImVec4 error_colour{1, 0.55F, 0.45F, 1}, faint_colour{0.62F, 0.64F, 0.67F, 1};

void heading(const char* text) {
    ImGui::Spacing();
    ImGui::PushStyleColor(ImGuiCol_Text, faint_colour);
    ImGui::TextUnformatted(text);
    ImGui::PopStyleColor();
    ImGui::Separator();
}

void show_camera_and_time(Model& model) {
    heading("Camera and time");
    const support::Orbit& orbit = model.info(0).orbit;
    ImGui::Text("view %.1f, %.1f   zoom %.2f", orbit.azimuth_degrees, orbit.elevation_degrees,
                orbit.zoom);
    if (ImGui::Button("reset")) model.reset_camera();
    ImGui::SameLine();
    ImGui::Checkbox("turn", &model.turns);
    if (!model.moves()) return;
    ImGui::SameLine();
    ImGui::Checkbox("play", &model.plays);
    auto seconds = static_cast<float>(model.time());
    ImGui::SetNextItemWidth(-1);
    if (ImGui::DragFloat("##time", &seconds, 0.02F, 0, 0, "time %.2f s"))
        model.set_time(static_cast<double>(seconds));
}

void show_display(Model& model) {
    heading("Display");
    ImGui::Checkbox("heat map", &model.heat_map);
    ImGui::SameLine();
    ImGui::Checkbox("split", &model.is_split);
    if (!model.is_split) return;
    ImGui::SameLine();
    auto part = static_cast<float>(model.split_at);
    ImGui::SetNextItemWidth(-1);
    if (ImGui::SliderFloat("##split", &part, 0, 1, "%.2f"))
        model.split_at = static_cast<double>(part);
}

// The last frames from left to right, with the longest as the scale.
void show_frame_times(const FrameTimes& times, const char* id) {
    if (times.milliseconds().empty()) return;
    const std::span<const float> ms = times.milliseconds();
    const float longest = std::ranges::max(ms);
    const std::optional<double> rate = times.frames_per_second();
    const std::string text =
        support::fixed(static_cast<double>(ms.back()), 1) + " ms" +
        (rate ? "   " + support::fixed(*rate, 1) + " frames/s" : std::string());
    ImGui::TextUnformatted(text.c_str());
    const std::string scale = "0 to " + support::fixed(static_cast<double>(longest), 0) + " ms";
    std::array<float, FrameTimes::most> bars{};
    std::ranges::copy_backward(ms, bars.end());
    ImGui::PlotHistogram(id, bars.data(), static_cast<int>(bars.size()), 0, scale.c_str(), 0,
                         1.1F * longest,
                         {ImGui::GetContentRegionAvail().x, 3.2F * ImGui::GetTextLineHeight()});
}

void show_facts(const Model& model, const Shown& shown, std::size_t side) {
    if (!shown.sides[side].error.empty()) {
        ImGui::PushStyleColor(ImGuiCol_Text, error_colour);
        ImGui::TextWrapped("%s", shown.sides[side].error.c_str());
        ImGui::PopStyleColor();
        return;
    }
    for (const auto& [name, text] : model.info(side).facts) {
        ImGui::PushStyleColor(ImGuiCol_Text, faint_colour);
        ImGui::TextUnformatted(name.c_str());
        ImGui::PopStyleColor();
        ImGui::SameLine(0.32F * ImGui::GetWindowWidth());
        ImGui::TextWrapped("%s", text.c_str());
    }
}

void show_frames(const Model& model, const Shown& shown) {
    const std::size_t sides = model.is_split ? 2 : 1;
    for (std::size_t side = 0; side < sides; ++side) {
        heading(sides == 1 ? "Frames" : side == 0 ? "Frames of the left" : "Frames of the right");
        if (shown.sides[side].error.empty())
            show_frame_times(model.times(side), side == 0 ? "##left" : "##right");
        show_facts(model, shown, side);
    }
    if (shown.progress >= 0)
        ImGui::ProgressBar(static_cast<float>(shown.progress), {-FLT_MIN, 0}, "working");
}

}  // namespace

void show_panel(Model& model, const Shown& shown, float width) {
    ImGui::SetNextWindowPos({0, 0});
    ImGui::SetNextWindowSize({width, ImGui::GetIO().DisplaySize.y});
    ImGui::Begin("panel", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                     ImGuiWindowFlags_NoBringToFrontOnFocus);
    const float foot = 2 * ImGui::GetFrameHeightWithSpacing() + ImGui::GetTextLineHeight();
    ImGui::BeginChild("settings", {0, -foot});
    show_scene(model);
    show_controls(model);
    show_camera_and_time(model);
    show_display(model);
    show_frames(model, shown);
    ImGui::EndChild();
    ImGui::Separator();
    if (ImGui::Button("save picture")) model.wishes.save = true;
    ImGui::SameLine();
    if (ImGui::Button("copy command")) model.wishes.copy = true;
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", model.command_line().c_str());
    ImGui::PushStyleColor(ImGuiCol_Text, faint_colour);
    ImGui::TextUnformatted(!model.status.empty() ? model.status.c_str()
                           : shown.is_drawing    ? "drawing"
                                                 : "cellist-view --help lists the keys");
    ImGui::PopStyleColor();
    ImGui::End();
}

}  // namespace viewer
