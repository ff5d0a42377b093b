// SPDX-License-Identifier: MIT
// The thread that draws: pictures are those of the programs, and errors are answers.
#include <chrono>
#include <semaphore>

#include "drawing/drawing_thread.hpp"
#include "oit/support/files.hpp"
#include "oit/support/program.hpp"
#include "support/catch.hpp"
#include "support/errors.hpp"

namespace cellist::test {
namespace {

using viewer::Drawn;

// A drawing thread, and what waits for its answers.
class Drawing {
public:
    Drawn draw(const char* program, const std::vector<std::vector<std::string>>& sides,
               bool heat_map = false, std::optional<viewer::Pixel> pixel = {}) {
        viewer::Request request{
            .program = viewer::find_program(program), .heat_map = heat_map, .pixel = pixel};
        for (const std::vector<std::string>& words : sides)
            request.sides.push_back(viewer::read_arguments(words, request.program->controls));
        thread_.draw(request);
        while (true) {
            if (std::optional<Drawn> drawn = thread_.take()) return *drawn;
            answers_.acquire();
        }
    }
    std::string save(const std::filesystem::path& path, double split_at = 1) {
        thread_.save({.path = path, .split_at = split_at});
        while (true) {
            const std::vector<std::string> messages = thread_.take_messages();
            if (!messages.empty()) return messages.front();
            answers_.acquire();
        }
    }
    viewer::DrawingThread& thread() { return thread_; }

private:
    std::counting_semaphore<> answers_{0};
    viewer::DrawingThread thread_{[this] { answers_.release(); }};
};

// The picture of a program is what the thread saves, byte by byte.
void require_picture(const char* path, const char* program, const std::string& arguments) {
    INFO(program << " " << arguments);
    const Program offline(path);
    const ProgramResult result = offline.run(arguments + " --frames 1 --out offline.png");
    INFO(result.error);
    REQUIRE(result.exit_code == 0);
    std::istringstream text(arguments);
    std::vector<std::string> words;
    for (std::string word; text >> word;)
        words.push_back(word == "knot.obj" ? (offline.folder() / word).string() : word);
    Drawing drawing;
    const Drawn drawn = drawing.draw(program, {words});
    REQUIRE(drawn.sides.size() == 1);
    CHECK(drawn.sides[0].error.empty());
    CHECK(drawn.sides[0].rgba.size() == static_cast<std::size_t>(drawn.sides[0].width) *
                                            static_cast<std::size_t>(drawn.sides[0].height));
    CHECK(drawing.save(offline.folder() / "viewer.png").starts_with("saved "));
    CHECK(read_file(offline.folder() / "viewer.png") ==
          read_file(offline.folder() / "offline.png"));
}

TEST_CASE("pictures are those of the programs") {
    require_picture(CELLIST_OIT_PROGRAM, "oit", "knot.obj --size 64x48 --view 40,20 --zoom 1.5");
    require_picture(CELLIST_OIT_PROGRAM, "oit",
                    "knot.obj --size 50x40 --stereo 0.1 --opaque-floor --method kbuffer:4");
    require_picture(CELLIST_SHADOWS_PROGRAM, "shadows",
                    "room --width 64 --height 48 --view 20,10 --zoom 1.2");
    require_picture(CELLIST_MOTION_SHADOWS_PROGRAM, "motion-shadows",
                    "cubes --width 64 --height 48 --samples 4 --view 30,20");
}

TEST_CASE("pictures after a change of view and time are those of the program") {
    const Program offline(CELLIST_OIT_PROGRAM);
    const std::string moment = "gearworks --size 80x60 --view 50,-30 --time 0.9";
    REQUIRE(offline.run(moment + " --frames 1 --out offline.png").exit_code == 0);
    Drawing drawing;
    const auto sized = [](std::vector<std::string> words) {
        words.insert(words.begin(), {"gearworks", "--size", "80x60"});
        return words;
    };
    CHECK(drawing.draw("oit", {sized({})}).sides[0].info.moves);
    const Drawn drawn = drawing.draw("oit", {sized({"--view", "50,-30", "--time", "0.9"})});
    CHECK(drawn.sides[0].info.orbit.elevation_degrees == -30);
    (void)drawing.save(offline.folder() / "viewer.png");
    CHECK(read_file(offline.folder() / "viewer.png") ==
          read_file(offline.folder() / "offline.png"));
}

TEST_CASE("an error is an answer, and the next picture comes") {
    Drawing drawing;
    const auto error_of = [&](const char* program, const std::vector<std::string>& words) {
        return drawing.draw(program, {words}).sides[0].error;
    };
    CHECK(contains(error_of("oit", {"nosuch.ply"}), "neither a file nor a scene"));
    CHECK(drawing.save("a.png").starts_with("not saved: "));
    CHECK(contains(error_of("oit", {"smoke", "--samples", "exact", "--layers", "4"}),
                   "leave out --layers"));
    CHECK(contains(error_of("oit", {"smoke", "--samples", "exact", "--method", "weighted"}),
                   "cannot draw this"));
    CHECK(contains(error_of("oit", {"smoke", "--device", "no such device"}), "no such device"));
    CHECK(contains(error_of("oit", {"smoke", "--size", "100000x100000"}), "100000x100000"));
    CHECK(contains(error_of("motion-shadows", {"cubes", "--method", "all"}), "choose one"));
    CHECK(error_of("oit", {"smoke", "--size", "40x30"}).empty());
}

TEST_CASE("sides are drawn on their own, and joined in a file") {
    Drawing drawing;
    const std::vector<std::string> left{"smoke", "--size", "40x30"};
    std::vector<std::string> right = left;
    right.insert(right.end(), {"--method", "no_such_method"});
    const Drawn failed = drawing.draw("oit", {left, right});
    REQUIRE(failed.sides.size() == 2);
    CHECK(failed.sides[0].error.empty());
    CHECK(contains(failed.sides[1].error, "there is no method"));

    right.back() = "weighted";
    const Drawn both = drawing.draw("oit", {left, right});
    CHECK(both.sides[1].error.empty());
    CHECK(both.sides[0].rgba != both.sides[1].rgba);
    const Folder folder;
    (void)drawing.save(folder / "left.png", 1);
    (void)drawing.save(folder / "right.png", 0);
    (void)drawing.save(folder / "both.png", 0.5);
    const Drawn alone = drawing.draw("oit", {left});
    (void)drawing.save(folder / "alone.png", 0);
    CHECK(read_file(folder / "alone.png") == read_file(folder / "left.png"));
    CHECK(read_file(folder / "both.png") != read_file(folder / "left.png"));
    CHECK(read_file(folder / "both.png") != read_file(folder / "right.png"));
}

TEST_CASE("heat maps and lists are those of the scene") {
    Drawing drawing;
    const std::vector<std::string> words{"extreme-coplanar", "--size", "40x30"};
    const Drawn drawn = drawing.draw("oit", {words}, true, viewer::Pixel{20, 15});
    REQUIRE(drawn.sides[0].longest_list);
    REQUIRE(drawn.sides[0].list);
    CHECK(*drawn.sides[0].longest_list >= drawn.sides[0].list->size());
    CHECK(drawn.sides[0].heat_caption == "layers");
    const Folder folder;
    (void)drawing.save(folder / "viewer.png");
    const Program offline(CELLIST_OIT_PROGRAM);
    REQUIRE(offline.run("extreme-coplanar --size 40x30 --heatmap heat.png").exit_code == 0);
    CHECK(read_file(folder / "viewer.png") == read_file(offline.folder() / "heat.png"));

    const Drawn outside = drawing.draw("oit", {words}, false, viewer::Pixel{400, 15});
    CHECK_FALSE(outside.sides[0].list);
    const Drawn motion = drawing.draw(
        "motion-shadows", {{"cubes", "--width", "16", "--height", "12", "--samples", "1"}}, true);
    CHECK(contains(motion.sides[0].error, "heat map"));
}

TEST_CASE("the thread ends in the middle of a search") {
    Drawing drawing;
    viewer::Request request{.program = viewer::find_program("oit")};
    request.sides.push_back(viewer::read_arguments(
        std::vector<std::string>{"smoke", "--size", "64x48", "--budget", "40dB"},
        request.program->controls));
    drawing.thread().draw(request);
    CHECK_FALSE(drawing.thread().is_idle());
}

}  // namespace
}  // namespace cellist::test
