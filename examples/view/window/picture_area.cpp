// SPDX-License-Identifier: MIT
#include "window/picture_area.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

#include <imgui.h>

#include "heat_map.hpp"

namespace viewer {
namespace {

// Where a picture is in the window.
struct Place {
    ImVec2 corner, size;
    float scale;  // units for each pixel

    [[nodiscard]] float right() const { return corner.x + size.x; }
    [[nodiscard]] float bottom() const { return corner.y + size.y; }
    [[nodiscard]] Pixel pixel_at(const ImVec2& point) const {
        return {static_cast<int>(std::floor((point.x - corner.x) / scale)),
                static_cast<int>(std::floor((point.y - corner.y) / scale))};
    }
};

// As large as the area allows, in its middle, at whole pixels.
Place place_in(const ImVec2& corner, const ImVec2& area, const Texture& texture) {
    const auto width = static_cast<float>(texture.width());
    const auto height = static_cast<float>(texture.height());
    const float scale = std::min(area.x / width, area.y / height);
    const ImVec2 size(width * scale, height * scale);
    return {{corner.x + std::floor(0.5F * (area.x - size.x)),
             corner.y + std::floor(0.5F * (area.y - size.y))},
            size,
            scale};
}

// ImTextureID is a pointer or an integer.
ImTextureID texture_id(const Texture& texture) {
    return std::bit_cast<ImTextureID>(std::uint64_t{texture.name()});
}

void draw_part(const Texture& texture, const Place& place, float from, float to) {
    if (texture.name() == 0 || from >= to) return;
    ImGui::GetWindowDrawList()->AddImage(
        texture_id(texture), {place.corner.x + from * place.size.x, place.corner.y},
        {place.corner.x + to * place.size.x, place.bottom()}, {from, 0}, {to, 1});
}

// The border of a split view, with a handle in its middle.
void draw_border(const Place& place, float split_at) {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const float x = std::round(place.corner.x + split_at * place.size.x);
    const float y = place.corner.y + 0.5F * place.size.y;
    list.AddLine({x, place.corner.y}, {x, place.bottom()}, IM_COL32(255, 255, 255, 200), 1);
    list.AddCircleFilled({x, y}, 7, IM_COL32(255, 255, 255, 230));
    list.AddCircle({x, y}, 7, IM_COL32(0, 0, 0, 160));
}

void draw_label(const ImVec2& corner, const char* text) {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const ImVec2 size = ImGui::CalcTextSize(text);
    list.AddRectFilled(corner, {corner.x + size.x + 12, corner.y + size.y + 8},
                       IM_COL32(0, 0, 0, 170), 3);
    list.AddText({corner.x + 6, corner.y + 4}, IM_COL32_WHITE, text);
}

// What the sides differ in, at the top of each.
void draw_side_labels(const Model& model, const Place& place) {
    std::array<std::string, 2> texts;
    for (const Control& control : model.program().controls) {
        if (!control.splits || model.value(control, 0) == model.value(control, 1)) continue;
        for (std::size_t side = 0; side < texts.size(); ++side)
            texts[side] += (texts[side].empty() ? "" : ", ") + control.label + " " +
                           model.value(control, side);
    }
    if (texts[0].empty()) texts = {"left", "right: choose another setting"};
    draw_label({place.corner.x + 8, place.corner.y + 8}, texts[0].c_str());
    draw_label({place.right() - ImGui::CalcTextSize(texts[1].c_str()).x - 20, place.corner.y + 8},
               texts[1].c_str());
}

void draw_cross(const Place& place, const Pixel& pixel) {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const ImVec2 centre(place.corner.x + (static_cast<float>(pixel.x) + 0.5F) * place.scale,
                        place.corner.y + (static_cast<float>(pixel.y) + 0.5F) * place.scale);
    const auto cross = [&](ImU32 colour, float thickness) {
        for (const float sign : {-1.0F, 1.0F}) {
            list.AddLine({centre.x + sign * 4, centre.y}, {centre.x + sign * 12, centre.y}, colour,
                         thickness);
            list.AddLine({centre.x, centre.y + sign * 4}, {centre.x, centre.y + sign * 12}, colour,
                         thickness);
        }
    };
    cross(IM_COL32(0, 0, 0, 200), 4);
    cross(IM_COL32(255, 220, 80, 255), 2);
}

// The colours of a heat map and what they mean.
void draw_heat_scale(const Place& place, const DrawnSide& side) {
    constexpr float width = 220, bar_height = 10, margin = 10;
    const float line = ImGui::GetTextLineHeight();
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const ImVec2 corner(place.corner.x + margin,
                        place.bottom() - margin - 2 * line - bar_height - 16);
    list.AddRectFilled(corner, {corner.x + width + 16, place.bottom() - margin},
                       IM_COL32(0, 0, 0, 170), 3);
    const ImVec2 bar(corner.x + 8, corner.y + line + 8);
    list.AddText({bar.x, corner.y + 4}, IM_COL32_WHITE, side.heat_caption.c_str());
    constexpr int steps = 44;
    for (int i = 0; i < steps; ++i) {
        const auto colour = support::heat_colour(static_cast<double>(i) / (steps - 1));
        const float x = bar.x + width * static_cast<float>(i) / steps;
        list.AddRectFilled({x, bar.y}, {x + width / steps + 1, bar.y + bar_height},
                           IM_COL32(colour[0], colour[1], colour[2], 255));
    }
    const auto label = [&](float part, unsigned count) {
        const std::string text = std::to_string(count);
        const float x = bar.x + part * (width - ImGui::CalcTextSize(text.c_str()).x);
        list.AddText({x, bar.y + bar_height + 2}, IM_COL32_WHITE, text.c_str());
    };
    label(0, 0);
    if (*side.longest_list > 1) label(0.5F, *side.longest_list / 2);
    if (*side.longest_list > 0) label(1, *side.longest_list);
}

void take_mouse(Model& model, const Place& place) {
    static bool moves_border = false;
    const ImGuiIO& io = ImGui::GetIO();
    const float border = place.corner.x + static_cast<float>(model.split_at) * place.size.x;
    const bool is_near =
        model.is_split && ImGui::IsItemHovered() && std::abs(io.MousePos.x - border) < 8;
    if (is_near || moves_border) ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
    if (ImGui::IsItemActivated()) moves_border = is_near;
    if (ImGui::IsItemActive() && moves_border)
        model.split_at = std::clamp(
            static_cast<double>((io.MousePos.x - place.corner.x) / place.size.x), 0.0, 1.0);
    else if (ImGui::IsItemActive() && ImGui::IsMouseDragging(ImGuiMouseButton_Left))
        model.drag_by(static_cast<double>(io.MouseDelta.x), static_cast<double>(io.MouseDelta.y));
    if (ImGui::IsItemDeactivated()) {
        const ImVec2 moved = ImGui::GetMouseDragDelta(ImGuiMouseButton_Left, 0);
        if (!moves_border && std::hypot(moved.x, moved.y) < 3)
            model.click(place.pixel_at(io.MousePos));
        moves_border = false;
    }
    if (ImGui::IsItemHovered() && io.MouseWheel != 0)
        model.scroll(static_cast<double>(io.MouseWheel));
}

}  // namespace

void show_picture_area(Model& model, const Shown& shown, float left) {
    const ImVec2 display = ImGui::GetIO().DisplaySize;
    const ImVec2 area(display.x - left, display.y);
    ImGui::SetNextWindowPos({left, 0});
    ImGui::SetNextWindowSize(area);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(0, 0));
    ImGui::Begin("picture", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoBackground |
                     ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoBringToFrontOnFocus |
                     ImGuiWindowFlags_NoNav);
    const Texture& left_picture = shown.textures[0];
    if (left_picture.name() != 0 && area.x > 0) {
        const Place place = place_in({left, 0}, area, left_picture);
        const bool is_split = model.is_split && shown.textures[1].name() != 0;
        const auto split_at = static_cast<float>(is_split ? model.split_at : 1);
        draw_part(left_picture, place, 0, split_at);
        draw_part(shown.textures[1], place, split_at, 1);
        if (model.pixel) draw_cross(place, *model.pixel);
        if (is_split) {
            draw_border(place, split_at);
            draw_side_labels(model, place);
        }
        if (shown.request.heat_map && shown.sides[0].longest_list)
            draw_heat_scale(place, shown.sides[0]);
        ImGui::SetCursorPos({0, 0});
        ImGui::InvisibleButton("mouse", area);
        take_mouse(model, place);
    }
    ImGui::End();
    ImGui::PopStyleVar();
}

std::pair<int, int> picture_area_size(std::pair<int, int> window_size, float left,
                                      float pixels_per_unit) {
    const auto pixels = [&](float units) {
        return std::max(1, static_cast<int>(std::lround(units * pixels_per_unit)));
    };
    return {pixels(static_cast<float>(window_size.first) - left),
            pixels(static_cast<float>(window_size.second))};
}

}  // namespace viewer
