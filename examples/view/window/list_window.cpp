// SPDX-License-Identifier: MIT
#include "window/list_window.hpp"

#include <algorithm>
#include <vector>

#include <imgui.h>

#include "image.hpp"
#include "number_text.hpp"

namespace viewer {
namespace {

ImVec4 shown_colour(const ListEntry& entry) {
    const auto encoded = [&](int channel) {
        return static_cast<float>(support::srgb_from_linear(entry.colour[channel]));
    };
    return {encoded(0), encoded(1), encoded(2), 1};
}

void show_entry(const ListEntry& entry, std::size_t i) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::Text("%zu", i + 1);
    ImGui::TableNextColumn();
    ImGui::Text("%.5f", entry.depth);
    ImGui::TableNextColumn();
    ImGui::PushID(static_cast<int>(i));
    ImGui::ColorButton("##colour", shown_colour(entry),
                       ImGuiColorEditFlags_NoTooltip | ImGuiColorEditFlags_NoDragDrop,
                       {ImGui::GetTextLineHeight(), ImGui::GetTextLineHeight()});
    ImGui::PopID();
    ImGui::SameLine();
    ImGui::Text("%.3f %.3f %.3f", entry.colour[0], entry.colour[1], entry.colour[2]);
    ImGui::TableNextColumn();
    ImGui::Text("%.3f", entry.alpha);
    ImGui::TableNextColumn();
    ImGui::Text("%s", entry.blend.c_str());
}

void show_entries(const std::vector<ListEntry>& list) {
    constexpr std::size_t most_rows = 12;
    const float rows = static_cast<float>(std::min(list.size(), most_rows) + 1);
    if (!ImGui::BeginTable(
            "list", 5, ImGuiTableFlags_ScrollY | ImGuiTableFlags_RowBg,
            {30 * ImGui::GetFontSize(), rows * (ImGui::GetTextLineHeight() + 6) + 4}))
        return;
    ImGui::TableSetupScrollFreeze(0, 1);
    constexpr std::pair<const char*, float> columns[] = {
        {"#", 1}, {"depth", 2.5F}, {"linear colour", 5}, {"alpha", 2}, {"blend", 2.5F}};
    for (const auto& [name, width] : columns)
        ImGui::TableSetupColumn(name, ImGuiTableColumnFlags_WidthStretch, width);
    ImGui::TableHeadersRow();
    for (std::size_t i = 0; i < list.size(); ++i) show_entry(list[i], i);
    ImGui::EndTable();
}

}  // namespace

void show_list(const Model& model, const Shown& shown) {
    if (!model.pixel || !shown.sides[0].error.empty()) return;
    const ImVec2 display = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({display.x - 10, display.y - 10}, ImGuiCond_Always, {1, 1});
    ImGui::SetNextWindowBgAlpha(0.85F);
    ImGui::Begin("pixel", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize |
                     ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoFocusOnAppearing);
    ImGui::Text("pixel %d, %d:", model.pixel->x, model.pixel->y);
    ImGui::SameLine();
    const std::optional<std::vector<ListEntry>>& list = shown.sides[0].list;
    if (!list)
        ImGui::TextUnformatted("the pixels of this program have no lists");
    else
        ImGui::TextUnformatted(support::counted(list->size(), "fragment").c_str());
    if (list && !list->empty()) show_entries(*list);
    ImGui::End();
}

}  // namespace viewer
