// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <cellist/opencl.hpp>

struct GLFWwindow;

namespace viewer {

/// A picture in the memory of OpenGL.
class Texture {
public:
    Texture() = default;
    ~Texture();
    Texture(const Texture&) = delete;
    Texture& operator=(const Texture&) = delete;

    /// Row by row from the top, 8 bits a channel, red lowest. The context of the window must be
    /// current.
    void upload(const std::vector<cl_uint>& rgba, int width, int height);
    [[nodiscard]] unsigned name() const { return name_; }
    [[nodiscard]] int width() const { return width_; }
    [[nodiscard]] int height() const { return height_; }

private:
    unsigned name_ = 0;  // 0: none yet
    int width_ = 0, height_ = 0;
};

/// A window with an OpenGL context and Dear ImGui.
class Window {
public:
    /// Throws InputError where there is no display or no OpenGL.
    Window(const std::string& title, int width, int height);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    /// Called with the name of a key that is pressed: "a", "space", "left" and so on.
    std::function<void(const std::string&)> on_key;
    void press(int key, int scancode, int action, int modifiers);

    /// Waits for input, wake() or this time, then handles all input.
    void wait_events(double seconds);
    /// Whether there was input since the last call.
    [[nodiscard]] bool take_input() { return std::exchange(has_input_, false); }
    /// Ends wait_events(). May be called on any thread.
    static void wake();
    /// Draws the window with the calls of ImGui that `draw` makes. `before_swap` can read it.
    void show(const std::function<void()>& draw, const std::function<void()>& before_swap);

    [[nodiscard]] bool is_closed() const;
    void close();
    /// The user sees no window any more.
    void hide();
    void resize(int width, int height);
    void set_title(const std::string& title);
    void copy(const std::string& text);
    /// By how much the user's system enlarges text, beyond what its units of length do.
    [[nodiscard]] float scale() const;
    /// Pixels for each unit of length.
    [[nodiscard]] float pixels_per_unit() const;
    /// Width and height in units of length.
    [[nodiscard]] std::pair<int, int> size() const;
    /// Writes the window as it was drawn last, for `before_swap`. Throws as write_file() does.
    void write_screenshot(const std::string& path) const;

private:
    static void note_input(GLFWwindow* window);

    GLFWwindow* window_ = nullptr;
    bool has_input_ = false;
};

}  // namespace viewer
