// SPDX-License-Identifier: MIT
#include "window/window.hpp"

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <utility>

#define GLFW_INCLUDE_GLEXT
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include "image.hpp"
#include "input_error.hpp"

namespace viewer {
namespace {

constexpr float font_size = 15;
constexpr const char* font_files[] = {"/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf",
                                      "/usr/share/fonts/dejavu-sans-fonts/DejaVuSans.ttf",
                                      "/usr/share/fonts/TTF/DejaVuSans.ttf"};

std::string last_error() {
    const char* text = nullptr;
    glfwGetError(&text);
    return text == nullptr ? "" : std::string(": ") + text;
}

// Layouts of keyboards move letters: the name that the layout has for a key counts.
std::string name_of_key(int key, int scancode) {
    constexpr std::pair<int, const char*> named[] = {
        {GLFW_KEY_SPACE, "space"}, {GLFW_KEY_TAB, "tab"},      {GLFW_KEY_ESCAPE, "escape"},
        {GLFW_KEY_LEFT, "left"},   {GLFW_KEY_RIGHT, "right"},  {GLFW_KEY_UP, "up"},
        {GLFW_KEY_DOWN, "down"},   {GLFW_KEY_EQUAL, "+"},      {GLFW_KEY_KP_ADD, "+"},
        {GLFW_KEY_MINUS, "-"},     {GLFW_KEY_KP_SUBTRACT, "-"}};
    for (const auto& [code, name] : named)
        if (key == code) return name;
    const char* name = glfwGetKeyName(key, scancode);
    return name == nullptr ? "" : name;
}

void load_font(float scale) {
    ImFontAtlas& fonts = *ImGui::GetIO().Fonts;
    std::error_code error;
    for (const char* file : font_files)
        if (std::filesystem::exists(file, error) &&
            fonts.AddFontFromFileTTF(file, font_size * scale) != nullptr)
            return;
    ImFontConfig config;
    config.SizePixels = font_size * scale;
    fonts.AddFontDefault(&config);
}

void set_style(float scale) {
    ImGui::StyleColorsDark();
    ImGuiStyle& style = ImGui::GetStyle();
    style.WindowRounding = style.PopupRounding = 0;
    style.FrameRounding = style.GrabRounding = 3;
    style.WindowBorderSize = 0;
    style.WindowPadding = {12, 12};
    style.ItemSpacing = {8, 6};
    style.Colors[ImGuiCol_WindowBg] = {0.11F, 0.12F, 0.13F, 1};
    style.ScaleAllSizes(scale);
}

}  // namespace

Texture::~Texture() {
    if (name_ != 0) glDeleteTextures(1, &name_);
}

void Texture::upload(const std::vector<cl_uint>& rgba, int width, int height) {
    if (name_ == 0) glGenTextures(1, &name_);
    glBindTexture(GL_TEXTURE_2D, name_);
    if (width != width_ || height != height_) {
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
        glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                     rgba.data());
    } else {
        glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE,
                        rgba.data());
    }
    width_ = width;
    height_ = height;
}

Window::Window(const std::string& title, int width, int height) {
    if (glfwInit() != GLFW_TRUE)
        throw support::InputError("there is no display to open a window on" + last_error());
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 0);
    window_ = glfwCreateWindow(width, height, title.c_str(), nullptr, nullptr);
    if (window_ == nullptr) {
        const std::string reason = last_error();
        glfwTerminate();
        throw support::InputError("there is no OpenGL 3.0 for a window" + reason);
    }
    glfwMakeContextCurrent(window_);
    glfwSwapInterval(1);
    glfwSetWindowUserPointer(window_, this);
    // ImGui calls these before its own.
    glfwSetKeyCallback(window_, [](GLFWwindow* window, int key, int scancode, int action,
                                   int mods) {
        note_input(window);
        static_cast<Window*>(glfwGetWindowUserPointer(window))->press(key, scancode, action, mods);
    });
    glfwSetCharCallback(window_, [](GLFWwindow* window, unsigned) { note_input(window); });
    glfwSetCursorPosCallback(window_,
                             [](GLFWwindow* window, double, double) { note_input(window); });
    glfwSetCursorEnterCallback(window_, [](GLFWwindow* window, int) { note_input(window); });
    glfwSetMouseButtonCallback(window_,
                               [](GLFWwindow* window, int, int, int) { note_input(window); });
    glfwSetScrollCallback(window_, [](GLFWwindow* window, double, double) { note_input(window); });
    glfwSetFramebufferSizeCallback(window_,
                                   [](GLFWwindow* window, int, int) { note_input(window); });
    glfwSetWindowRefreshCallback(window_, [](GLFWwindow* window) { note_input(window); });
    IMGUI_CHECKVERSION();
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr;
    load_font(scale());
    set_style(scale());
    ImGui_ImplGlfw_InitForOpenGL(window_, true);
    ImGui_ImplOpenGL3_Init("#version 130");
}

Window::~Window() {
    ImGui_ImplOpenGL3_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
    glfwDestroyWindow(window_);
    glfwTerminate();
}

void Window::note_input(GLFWwindow* window) {
    static_cast<Window*>(glfwGetWindowUserPointer(window))->has_input_ = true;
}

void Window::press(int key, int scancode, int action, int modifiers) {
    const bool has_modifier = (modifiers & (GLFW_MOD_CONTROL | GLFW_MOD_ALT)) != 0;
    if (action == GLFW_RELEASE || has_modifier || ImGui::GetIO().WantTextInput) return;
    if (on_key) on_key(name_of_key(key, scancode));
}

void Window::wait_events(double seconds) { glfwWaitEventsTimeout(seconds); }

void Window::wake() { glfwPostEmptyEvent(); }

void Window::show(const std::function<void()>& draw, const std::function<void()>& before_swap) {
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
    draw();
    ImGui::Render();
    int width = 0, height = 0;
    glfwGetFramebufferSize(window_, &width, &height);
    glViewport(0, 0, width, height);
    glClearColor(0.06F, 0.06F, 0.07F, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
    before_swap();
    glfwSwapBuffers(window_);
}

bool Window::is_closed() const { return glfwWindowShouldClose(window_) == GLFW_TRUE; }

void Window::close() { glfwSetWindowShouldClose(window_, GLFW_TRUE); }

void Window::hide() {
    glfwHideWindow(window_);
    glfwPollEvents();
}

void Window::resize(int width, int height) { glfwSetWindowSize(window_, width, height); }

void Window::set_title(const std::string& title) { glfwSetWindowTitle(window_, title.c_str()); }

void Window::copy(const std::string& text) { glfwSetClipboardString(window_, text.c_str()); }

float Window::scale() const {
    float x = 1, y = 1;
    glfwGetWindowContentScale(window_, &x, &y);
    return x / pixels_per_unit();
}

float Window::pixels_per_unit() const {
    int pixels = 0, height = 0;
    glfwGetFramebufferSize(window_, &pixels, &height);
    return static_cast<float>(pixels) / static_cast<float>(std::max(1, size().first));
}

std::pair<int, int> Window::size() const {
    int width = 0, height = 0;
    glfwGetWindowSize(window_, &width, &height);
    return {width, height};
}

void Window::write_screenshot(const std::string& path) const {
    int width = 0, height = 0;
    glfwGetFramebufferSize(window_, &width, &height);
    const std::size_t row = 3 * static_cast<std::size_t>(width);
    std::vector<std::uint8_t> bytes(row * static_cast<std::size_t>(height));
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, width, height, GL_RGB, GL_UNSIGNED_BYTE, bytes.data());
    // OpenGL begins at the bottom.
    for (std::size_t top = 0, bottom = static_cast<std::size_t>(height); top + 1 < bottom; ++top) {
        --bottom;
        std::swap_ranges(bytes.begin() + static_cast<std::ptrdiff_t>(top * row),
                         bytes.begin() + static_cast<std::ptrdiff_t>((top + 1) * row),
                         bytes.begin() + static_cast<std::ptrdiff_t>(bottom * row));
    }
    support::write_bytes_as_image(path, bytes, width, height);
}

}  // namespace viewer
