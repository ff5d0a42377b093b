// SPDX-License-Identifier: MIT
// The program refuses what it cannot do, in one line that names the value.
#include <tuple>
#include <utility>

#include "oit/support/program.hpp"

namespace cellist::test {
namespace {

TEST_CASE("bad arguments are refused") {
    const Program program(CELLIST_OIT_PROGRAM);
    (void)program.folder().write("zero.cl", std::string("a\0b", 3));
    (void)program.folder().write("empty.cl", "");
    (void)program.folder().write("large.cl", std::string((1 << 20) + 1, ' '));
    for (const auto& [arguments, named] : {
             std::pair<std::string, std::string>{"--size 0x0", "0x0"},
             {"--size 100000x100000", "100000x100000"},
             {"--size 20000x10", "16384"},
             {"--size 12x", "12x"},
             {"--size 1280x720x3", "1280x720x3"},
             {"--size -5x7", "-5x7"},
             {"--size big", "big"},
             {"--size 99999999999999999999x1", "99999999999999999999x1"},
             {"--alpha nan", "nan"},
             {"--alpha -0.1", "-0.1"},
             {"--alpha 1.01", "1.01"},
             {"--alpha half", "half"},
             {"--layers 0", "1 to"},
             {"--layers -3", "-3"},
             {"--layers some", "some"},
             {"--view 1", "1"},
             {"--view 1,2,3", "1,2,3"},
             {"--view 0,91", "90"},
             {"--view nan,0", "nan,0"},
             {"--frames 0", "0"},
             {"--device nosuchdevice", "nosuchdevice"},
             {"--out missing/folder/a.png", "missing/folder"},
             {"--out .", "folder"},
             {"--json missing/folder/a.json", "missing/folder"},
             {"--samples 3", "2, 4, 8 or exact"},
             {"--samples 0", "0"},
             {"--resolve both", "both"},
             {"--depth-range", "--samples"},
             {"--format rgba9", "rgb565_d16"},
             {"--depth-scale odd", "odd"},
             {"--epsilon 1.5", "1.5"},
             {"--method weighted --epsilon 0.1", "keeps no fragments"},
             {"--method moments --format rgba8", "keeps no fragments"},
             {"--out x.png --json ./x.png", "same file"},
             {"--out knot.obj", "the mesh"},
             {"--resolve sample", "--samples"},
             {"--resolve pixel", "--samples"},
             {"--time 1", "nothing moves"},
             {"--until 1", "nothing moves"},
             {"--budget 40dB --check-every 2", "--until or --turn"},
             {"--out a.gif", ".exr"},
             {"--out a", ".png"},
             {"--write-reference a.txt", ".jpg"},
             {"--out %s.png", "%04d"},
             {"--out %d-%d.png", "once"},
             {"--write-reference oit.png", "same file"},
             {"--out f-%02d.png --json ./f-01.png", "same file"},
             {"--blend /dev/zero", "regular file"},
             {"--blend zero.cl", "byte of 0"},
             {"--blend large.cl", "1048576 bytes"},
             {"--blend empty.cl", "empty"},
             {"--check-every 2", "--budget"},
             {"--turn 90 --frames 1", "--frames is 1"},
             {"--until 1 --frames 1", "--frames is 1"},
             {"--turn 1e10", "1000000"},
             {"--epsilon nan", "nan"},
             {"--stereo -1", "-1"},
             {"--time inf", "inf"},
             {"--blend nosuch.cl", "nosuch.cl"},
             {"--blend .", "folder"},
             {"--method nosuch", "weighted"},
             {"--method linkde", "did you mean 'linked'?"},
             {"--sise 3x3", "did you mean '--size'?"},
             {"--budget 40dBs", "such as 40dB"},
             {"--method adaptive:7", "8, 16"},
             {"--method linked:8", "no sizes"},
             {"--method adaptive:", "8, 16"},
             {"--method dual_peeling --layers 3", "dual_peeling"},
             {"--method kbuffer:4 --layers 6", "keeps 4 layers, and cannot blend 6"},
             {"--method weighted --blend additive", "weighted"},
             {"--memory 0", "such as 64MiB"},
             {"--memory -1", "-1"},
             {"--memory 64MB", "64MB"},
             {"--memory 1.5GiB", "1.5GiB"},
             {"--memory MiB", "MiB"},
             {"--memory 99999999999GiB", "99999999999GiB"},
             {"--memory 1KiB", "--memory of 1024 bytes is too little"},
             {"--memory 1KiB --layers 2", "it needs at least"},
             {"--memory 1KiB --method weighted", "over the 1024 of --memory"},
             {"--reduce 0", "1, 2 or 4"},
             {"--reduce 3", "1, 2 or 4"},
             {"--reduce 2 --samples 4", "one sample"},
             {"--reduce 2 --samples exact", "one sample"},
             {"--reduce 2 --lens 0.1,4", "--lens"},
             {"--samples exactly", "8 or exact"},
             {"--samples all", "cellist-tradeoff"},
             {"--samples exact --blend absorb", "--samples 8"},
             {"--samples exact --depth-range", "has none"},
             {"--samples exact --resolve sample", "has none"},
             {"--samples exact --layers 4", "all triangles"},
             {"--samples exact --budget 40dB", "no error bound"},
             {"--samples exact --method weighted", "all triangles"},
             {"--samples exact --method peeling", "all triangles"},
             {"--samples exact --method kbuffer", "all triangles"},
             {"--samples exact --lens 0.1,4", "one sample"},
             {"--samples 4 --lens 0.1,4", "one sample"},
             {"--lens 0.1", "RADIUS,FOCUS"},
             {"--lens ,4", "RADIUS,FOCUS"},
             {"--lens 0.1,4,5", "RADIUS,FOCUS"},
             {"--lens 0.1,nan", "RADIUS,FOCUS"},
             {"--lens nan,4", "0 to 100"},
             {"--lens -0.1,4", "0 to 100"},
             {"--lens 101,4", "0 to 100"},
             {"--lens 0.1,0", "at least 1e-06"},
             {"--lens 0.1,4 --memory 64MiB", "--memory"},
             {"--lens 0.1,4 --budget 40dB", "no error bound"},
             {"--lens 0.1,4 --method weighted", "a lens needs"},
             {"--lens 0.1,4 --method dual_peeling", "a lens needs"},
             {"--lens 0.1,4 --method peeled:4 --layers 2", "leave out --layers"},
             {"--lens 0.1,4 --method positions --layers 2", "leave out --layers"},
             {"--lens 0.1,4 --method positions --lens-rays 8", "sends no rays"},
             {"--lens-rays 8", "--lens, which is not given"},
             {"--lens 0.1,4 --lens-rays 0", "0"},
             {"--reduce 2 --budget 40dB", "--reduce"},
             {"--memory 1GiB --budget 40dB", "--memory"},
             {"--budget 1/1", "every picture meets this"},
             {"--bogus", "--bogus"},
             {"another.obj", "another.obj"},
         })
        program.require_refused("knot.obj " + arguments, named);
    program.require_refused("", "mesh");
    program.require_refused("nosuch.obj", "nosuch.obj");
    program.require_refused("gearwork", "(did you mean 'gearworks'?); --help lists the scenes");
    program.require_refused("extreme-layers --alpha 0.5", "opacities of their own");
    program.require_refused("/dev/null", "not a regular file");
    program.require_refused("fifo", "not a regular file", "mkfifo fifo;");
    program.require_refused(".", "folder");
}

TEST_CASE("a machine without OpenCL is reported") {
    const Program program(CELLIST_OIT_PROGRAM);
    program.require_refused("knot.obj", "no OpenCL device",
                            "OCL_ICD_VENDORS=/nonexistent OCL_ICD_FILENAMES=");
    program.require_refused("knot.obj", "nosuchdevice", "CELLIST_DEVICE=nosuchdevice");
}

TEST_CASE("arguments that start with a minus and extreme ones are accepted") {
    const Program program(CELLIST_OIT_PROGRAM);
    for (const std::string arguments :
         {"--view -30,-10", "--size 1x1", "--size 3x200", "--alpha 0", "--alpha 1",
          "--layers 4294967295", "--view 0,90 --opaque-floor", "--view 0,-90 --opaque-floor"}) {
        INFO(arguments);
        const ProgramResult result =
            program.run("knot.obj --frames 1 --out a.png --size 40x30 " + arguments);
        // An option that is given twice is refused by the parser, so sizes replace the default.
        const ProgramResult again =
            contains(arguments, "--size")
                ? program.run("knot.obj --frames 1 --out a.png " + arguments)
                : result;
        INFO(again.error);
        CHECK(again.exit_code == 0);
    }
}

TEST_CASE("scenes with nothing to blend, or with nothing at all, are drawn") {
    const Program program(CELLIST_OIT_PROGRAM);
    for (const std::string scene : {"extreme-nothing", "extreme-opaque", "extreme-nan"}) {
        INFO(scene);
        const ProgramResult result =
            program.run(scene + " --size 40x30 --frames 1 --reference --samples 2 --stereo 0.2");
        INFO(result.error);
        CHECK(result.exit_code == 0);
        CHECK(contains(result.out, "0 of 2,400 pixels"));
    }
}

TEST_CASE("the user's function is read from a file, and its failures are shown") {
    const Program program(CELLIST_OIT_PROGRAM);
    const std::string head =
        "static void blend(const OitFragment* fragment, float distance, float3* colour,\n"
        "                  float3* transmittance) {\n";
    (void)program.folder().write("fine.cl", "\xEF\xBB\xBF" + head + "*transmittance *= 0.5f; }");
    (void)program.folder().write("nan.cl", head + "*colour = NAN; }");
    (void)program.folder().write("bad.cl", head + "*colour = nothing; }");
    const std::string run = "knot.obj --size 64x48 --frames 1 --blend ";
    const ProgramResult fine = program.run(run + "fine.cl");
    INFO(fine.error);
    CHECK(fine.exit_code == 0);
    CHECK_FALSE(contains(fine.out, "NaN"));
    CHECK(program.run(run + "'" CELLIST_FOG_PATH "'").exit_code == 0);
    program.require_refused("knot.obj --blend fine.cl --json ./fine.cl", "--blend");
    program.require_refused("knot.obj --size 64x48 --reference --blend fine.cl", "reference");
    program.require_refused("knot.obj --size 64x48 --budget 40dB --blend fine.cl", "--budget");
    program.require_refused("knot.obj --budget ''", "empty");
    CHECK(contains(program.run(run + "nan.cl").out, "NaN"));
    const ProgramResult bad = program.run(run + "bad.cl");
    CHECK(bad.exit_code == 1);
    CHECK(contains(bad.error, "bad.cl"));
    CHECK(contains(bad.error, "nothing"));
}

TEST_CASE("slots are not fewer than the layers that are blended") {
    const Program program(CELLIST_OIT_PROGRAM);
    for (const std::string layers : {"2", "4", "all"})
        CHECK(program.run("knot.obj --size 40x30 --frames 1 --method kbuffer:4 --layers " + layers)
                  .exit_code == 0);
}

}  // namespace
}  // namespace cellist::test
