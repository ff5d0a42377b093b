// SPDX-License-Identifier: MIT
#include "cases.hpp"

#include <iterator>
#include <sstream>

#include "command_line.hpp"
#include "input_error.hpp"
#include "scene/scenes.hpp"

namespace oit {
namespace {

// Ten scenes and views with three budgets each. A comment says what each of them tests.
const GridView views[]{
    // many pixels without layers, and few layers
    {"teapot", "teapot.obj", "--view 25,8", {"30dB", "40dB", "1/255"}},
    // opaque surfaces in between; little light passes
    {"teapot-floor",
     "teapot.obj",
     "--view 160,35 --alpha 0.7 --opaque-floor",
     {"35dB", "55dB", "4/255"}},
    // small triangles
    {"dragon", "dragon.ply", "--view 25,8", {"30dB", "40dB", "1/255"}},
    // coverage of samples
    {"dragon-samples",
     "dragon.ply",
     "--view -100,20 --alpha 0.6 --samples 4",
     {"35dB", "45dB", "2/255"}},
    // many layers, instances and opaque surfaces
    {"gearworks", "gearworks", "--view 25,8", {"30dB", "40dB", "1/255"}},
    {"gearworks-turned", "gearworks", "--view 120,40 --time 1.5", {"35dB", "55dB", "4/255"}},
    // each vertex with its own opacity
    {"smoke", "smoke", "--view 25,8", {"30dB", "40dB", "1/255"}},
    // media, for which the survey has no bounds of packed formats
    {"smoke-absorb", "smoke", "--blend absorb --view 80,-10", {"35dB", "50dB", "1/255"}},
    // instances of one mesh, for two eyes
    {"rings", "rings", "--view 40,30 --stereo 0.1", {"30dB", "45dB", "1/255"}},
    // depths do not tell the order; one budget is too tight for any float picture
    {"coplanar", "extreme-coplanar", "--view 0,0", {"30dB", "1/255", "199dB"}},
};

std::vector<std::string> words(const std::string& text) {
    std::istringstream in(text);
    std::vector<std::string> result;
    for (std::string word; in >> word;) result.push_back(word);
    return result;
}

}  // namespace

std::vector<GridView> grid_views(const std::filesystem::path& meshes) {
    std::vector<GridView> all(std::begin(views), std::end(views));
    for (GridView& view : all)
        if (is_of_mesh(view)) view.scene = (meshes / view.scene).string();
    return all;
}

GridView view_of_mesh(const std::filesystem::path& mesh) {
    return {mesh.stem().string(), mesh.string(), "--view 25,8", {"30dB", "40dB", "1/255"}};
}

FrameOptions frame_options(const GridView& view) {
    std::vector<const char*> pointers{"cellist-oit", view.scene.c_str()};
    const std::vector<std::string> arguments = words(view.arguments);
    for (const std::string& argument : arguments) pointers.push_back(argument.c_str());
    FrameOptions options;
    support::CommandLine line("cellist-oit", "");
    add_frame_options(line, options);
    (void)line.parse(static_cast<int>(pointers.size()), pointers.data());
    return options;
}

bool is_of_mesh(const GridView& view) { return find_scene(view.scene) == nullptr; }

}  // namespace oit
