// SPDX-License-Identifier: MIT
#include "window/control_widgets.hpp"

#include <algorithm>
#include <array>
#include <cfloat>
#include <cstdlib>
#include <string>
#include <vector>

#include <imgui.h>

#include "number_text.hpp"

namespace viewer {
namespace {

// A combo box. Returns the choice that the user made, or nothing.
std::string combo(const char* id, const std::string& now, const std::vector<std::string>& choices,
                  float width) {
    std::string chosen;
    ImGui::SetNextItemWidth(width);
    if (!ImGui::BeginCombo(id, now.c_str(), ImGuiComboFlags_HeightLarge)) return chosen;
    for (const std::string& choice : choices) {
        if (ImGui::Selectable(choice.c_str(), choice == now)) chosen = choice;
        if (choice == now) ImGui::SetItemDefaultFocus();
    }
    ImGui::EndCombo();
    return chosen;
}

// The parts of "kbuffer:8": a name and the size that some names have.
std::string name_part(const std::string& choice) { return choice.substr(0, choice.find(':')); }
std::string size_part(const std::string& choice) {
    const std::size_t colon = choice.find(':');
    return colon == std::string::npos ? "auto" : choice.substr(colon + 1);
}

// Choices with sizes are two combo boxes, a name and a size.
std::string choose(const Control& control, const std::string& now, float width) {
    const std::string name = name_part(now);
    std::vector<std::string> names, sizes;
    for (const std::string& choice : control.choices) {
        if (choice.find(':') == std::string::npos)
            names.push_back(choice);
        else if (name_part(choice) == name)
            sizes.push_back(size_part(choice));
    }
    if (sizes.empty()) return combo("##choice", now, names, width);
    const float size_width = std::min(0.42F * width, 5.0F * ImGui::GetFontSize());
    const float gap = ImGui::GetStyle().ItemInnerSpacing.x;
    std::string chosen = combo("##choice", name, names, width - size_width - gap);
    ImGui::SameLine(0, gap);
    sizes.insert(sizes.begin(), "auto");
    const std::string size = combo("##size", size_part(now), sizes, size_width);
    if (!size.empty()) chosen = size == "auto" ? name : name + ":" + size;
    return chosen;
}

void show_widget(Model& model, const Control& control, std::size_t side, float width) {
    const std::string now = model.value(control, side);
    const bool is_idle = model.is_idle(control, side);
    if (is_idle) ImGui::BeginDisabled();
    std::string chosen;
    if (control.kind == Control::Kind::choice) {
        chosen = choose(control, now, width);
    } else if (control.kind == Control::Kind::flag) {
        bool is_on = model.arguments().has(control.option);
        if (ImGui::Checkbox("##flag", &is_on)) chosen = is_on ? "on" : "off";
    } else if (control.kind == Control::Kind::number) {
        auto number = static_cast<float>(std::atof(now.c_str()));
        ImGui::SetNextItemWidth(width);
        if (ImGui::SliderFloat("##number", &number, static_cast<float>(control.least),
                               static_cast<float>(control.most), "%.2f"))
            chosen = support::fixed(static_cast<double>(number), 2);
    }
    if (is_idle) ImGui::EndDisabled();
    if (!chosen.empty()) model.set(control, chosen, side);
}

void show_scene_choice(Model& model, const Program& program,
                       const std::vector<std::string>& scene) {
    const std::string name = Model::scene_name(scene);
    const bool is_shown = &model.program() == &program && model.arguments().scene == scene;
    ImGui::PushID(&program);
    if (ImGui::Selectable(name.c_str(), is_shown)) model.show(program, scene);
    ImGui::PopID();
}

}  // namespace

void show_scene(Model& model) {
    ImGui::SetNextItemWidth(-FLT_MIN);
    const std::string now = model.program().title + ": " + model.scene_name();
    if (!ImGui::BeginCombo("##scene", now.c_str(), ImGuiComboFlags_HeightLarge)) return;
    for (const Program& program : programs()) {
        ImGui::TextDisabled("%s", program.title.c_str());
        ImGui::Indent();
        for (const auto& files : model.files()) show_scene_choice(model, program, files);
        for (const std::string& scene : program.scenes) show_scene_choice(model, program, {scene});
        ImGui::Unindent();
    }
    ImGui::EndCombo();
}

void show_controls(Model& model) {
    ImGui::Spacing();
    const float label_width = 6 * ImGui::GetFontSize();
    const float gap = ImGui::GetStyle().ItemSpacing.x;
    const float room = ImGui::GetContentRegionAvail().x - label_width;
    for (const Control& control : model.program().controls) {
        if (control.label.empty()) continue;
        ImGui::PushID(control.option.c_str());
        ImGui::AlignTextToFramePadding();
        ImGui::TextUnformatted(control.label.c_str());
        if (ImGui::IsItemHovered() && !control.hint.empty())
            ImGui::SetTooltip("%s: %s", control.option.c_str(), control.hint.c_str());
        ImGui::SameLine(label_width);
        const std::size_t sides = model.is_split && control.splits ? 2 : 1;
        const float width =
            (room - static_cast<float>(sides - 1) * gap) / static_cast<float>(sides);
        for (std::size_t side = 0; side < sides; ++side) {
            if (side > 0) ImGui::SameLine();
            ImGui::PushID(static_cast<int>(side));
            ImGui::BeginGroup();
            show_widget(model, control, side, width);
            ImGui::EndGroup();
            ImGui::PopID();
        }
        ImGui::PopID();
    }
}

}  // namespace viewer
