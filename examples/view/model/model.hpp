// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "drawing/request.hpp"
#include "model/frame_times.hpp"

namespace viewer {

/// What the viewer shows and how its inputs change that: everything but the window.
class Model {
public:
    /// Mesh files of the arguments stay in the list of scenes.
    Model(const Program& program, Arguments arguments);

    // ---- what is drawn
    [[nodiscard]] const Program& program() const { return *program_; }
    [[nodiscard]] const Arguments& arguments() const { return arguments_; }
    /// The scene of a command line in one text, files without their folders.
    [[nodiscard]] static std::string scene_name(const std::vector<std::string>& scene);
    [[nodiscard]] std::string scene_name() const { return scene_name(arguments_.scene); }
    /// Mesh files that were given on the command line, each an entry of its own.
    [[nodiscard]] const std::vector<std::vector<std::string>>& files() const { return files_; }
    /// Changes program and scene. Keeps options that do not belong to the scene.
    void show(const Program& program, std::vector<std::string> scene);

    /// The text of an option on a side, 0 or 1: as it was set, or the program's default.
    [[nodiscard]] std::string value(const Control& control, std::size_t side = 0) const;
    /// Sets an option. An empty text and the default remove it. Side 1 differs from side 0 in the
    /// options that are set for it.
    void set(const Control& control, const std::string& text, std::size_t side = 0);
    /// Has no effect beside the other options.
    [[nodiscard]] bool is_idle(const Control& control, std::size_t side = 0) const;
    /// Of the image of one eye.
    void set_picture_size(int width, int height);
    /// Images beside one another.
    [[nodiscard]] int eyes() const { return arguments_.has("--stereo") ? 2 : 1; }

    /// The command line of the program that draws the same picture.
    [[nodiscard]] std::string command_line(std::size_t side = 0) const;
    [[nodiscard]] Request request() const;

    // ---- camera and time
    /// Turns the camera. Has no effect before the first picture.
    void orbit_by(double azimuth_degrees, double elevation_degrees);
    void zoom_by(double factor);
    void reset_camera();
    /// The mouse is dragged by this many units of length: turns the camera.
    void drag_by(double x, double y);
    /// The wheel of the mouse turns away from the user: zooms in.
    void scroll(double steps);
    /// A click chooses the pixel whose list is shown; on the same pixel again, none.
    void click(const Pixel& place);
    [[nodiscard]] double time() const;
    void set_time(double seconds);
    /// Where the scene moves: see is_moving().
    bool plays = false;
    bool turns = false;  ///< the camera, around the scene
    [[nodiscard]] bool is_animated() const { return (plays && moves_) || turns; }
    /// Whether time changes the scene.
    [[nodiscard]] bool moves() const { return moves_; }
    /// The next moment of what plays or turns.
    void advance(double seconds);

    // ---- the window
    bool shows_panel = true;
    bool heat_map = false;
    bool is_split = false;
    double split_at = 0.5;            ///< part of the width that the left side has
    std::optional<Pixel> pixel = {};  ///< whose list is shown
    std::string status = {};          ///< the last message

    /// What a key asked for that the model cannot do itself.
    struct Wishes {
        bool quit = false, copy = false, save = false;
    };
    Wishes wishes = {};
    /// A key by its name: "space", "h", "left" and so on. False where it has no meaning.
    bool press(std::string_view key);

    // ---- answers
    /// Takes what was drawn of request(). `now_s` is the time of a clock.
    void take(const Drawn& drawn, double now_s);
    /// About the last picture of each side that had no error.
    [[nodiscard]] const PictureInfo& info(std::size_t side) const { return infos_[side]; }
    [[nodiscard]] const FrameTimes& times(std::size_t side) const { return times_[side]; }

private:
    [[nodiscard]] Arguments arguments_of(std::size_t side) const;

    const Program* program_;
    Arguments arguments_;
    Arguments right_;  // what the right side has in place of the options of the left one
    std::vector<std::vector<std::string>> files_;
    std::map<std::string, Arguments> others_;  // of programs that were shown before
    int width_ = 0, height_ = 0;
    bool has_orbit_ = false;
    bool moves_ = false;
    std::array<PictureInfo, 2> infos_;
    std::array<FrameTimes, 2> times_;
};

}  // namespace viewer
