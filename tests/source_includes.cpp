// SPDX-License-Identifier: MIT
// A device keeps programs, but none that includes other files: these may change while the program
// runs.
#include <filesystem>
#include <fstream>
#include <random>

#include "device/device_state.hpp"
#include "device/program_text.hpp"
#include "device/recent.hpp"
#include "support/errors.hpp"
#include "support/inserts.hpp"

namespace cellist::test {
namespace {

namespace fs = std::filesystem;

/// A folder that goes with the test.
struct Folder {
    Folder() { fs::create_directories(path); }
    ~Folder() { fs::remove_all(path); }
    void write(cl_uint value) const {
        std::ofstream(path / "value.h") << "#define VALUE " << value << "\n";
    }
    fs::path path =
        fs::temp_directory_path() / ("cellist-test-" + std::to_string(std::random_device{}()));
};

TEST_CASE("a source is read from a file, whose name errors show") {
    const Folder folder;
    const std::string path = (folder.path / "twice.cl").string();
    std::ofstream(path) << "kernel void twice(global uint* out) { *out = 2 * VALUE; }\n";
    const Buffer<cl_uint> out(device(), 1);
    Kernel(device(), Source::from_file(path, "-DVALUE=4"), "twice").run(1, out);
    REQUIRE(out.download().front() == 8);
    const auto error =
        error_of<OpenClError>([&] { Kernel(device(), Source::from_file(path), "twice"); });
    REQUIRE(contains(error.log(), path + ":1"));

    const auto refused = [](const std::string& name) {
        return std::string(error_of([&] { (void)Source::from_file(name); }).what());
    };
    REQUIRE(contains(refused(path + ".missing"), path + ".missing: No such file"));
    REQUIRE(contains(refused(folder.path.string()), "Is a directory"));
}

TEST_CASE("a header that changes is read again by the next kernel") {
    const Folder folder;
    const Buffer<cl_uint> out(device(), 1);
    const std::string kernel = "\nkernel void f(global uint* out) { *out = VALUE; }\n";
    const std::string in_folder = "-I" + folder.path.string();
    const std::vector<Source> sources{
        {.text = "#include \"value.h\"" + kernel, .options = in_folder},
        {.text = "#define FILE \"value.h\"\n %: /**/ inc\\\nlude FILE" + kernel,
         .options = in_folder},
    };
    for (const Source& source : sources) {
        INFO(source.text << source.options);
        for (const cl_uint value : {1u, 2u, 3u}) {
            folder.write(value);
            Kernel kernel_now(device(), source, "f");
            kernel_now.run(1, out);
            REQUIRE(out.download()[0] == value);
        }
    }
}

TEST_CASE("every way to include a file is known") {
    for (const char* source :
         {"#include \"a.h\"", "  #  include <a.h>", "x\n#include A", "%:include \"a.h\"",
          "#inc\\\nlude \"a.h\"", "#\\\r\ninclude \"a.h\"", "# /* a\n b */ include \"a.h\"",
          "/* a\n*/ #include \"a.h\"", "#inc\\ \t\nlude \"a.h\"", "#\tinclude_next <a.h>",
          "#import <a.h>", "#if 0\n#endif\n#embed \"a\"", "\f#\vinclude \"a.h\"",
          "#/**//**/include A"}) {
        INFO(source);
        REQUIRE(detail::includes_files(source, ""));
    }
    for (const char* source :
         {"", "#", "#define include 1", "int include;", "#pragma once", "a % b", "#\ninclude",
          "#define A(x) #x", "// include \"a.h\"", "a ? b : c", "/*", "# /*"})
        REQUIRE_FALSE(detail::includes_files(source, "-I/usr/include -DX=1"));
    for (const char* options : {"-include a.h", "-Ia -includea.h", "-imacros a.h"})
        REQUIRE(detail::includes_files("", options));
}

TEST_CASE("sources without files of their own are built once") {
    const auto programs = [](const Source& source) {
        const auto& state = device().state();
        return std::pair(state->programs.get(source.text, source.options).program(),
                         state->programs.get(source.text, source.options).program());
    };
    const auto [first, again] =
        programs({.text = "kernel void f(global uint* out) { *out = 1234567; }"});
    REQUIRE(first == again);
}

TEST_CASE("the values that were used last are kept") {
    detail::Recent<int, std::unique_ptr<int>> recent(3);
    for (int i = 0; i < 3; ++i) recent.add(i, std::make_unique<int>(10 * i));
    const int* zero = recent.find(0)->get();
    recent.add(3, std::make_unique<int>(30));
    REQUIRE(recent.size() == 3);
    REQUIRE(recent.find(1) == nullptr);
    for (const int i : {0, 2, 3}) REQUIRE(**recent.find(i) == 10 * i);
    REQUIRE(recent.find(0)->get() == zero);
    recent.add(1, std::make_unique<int>(11));
    REQUIRE(recent.find(2) == nullptr);
    REQUIRE(**recent.find(1) == 11);
    REQUIRE(recent.size() == 3);
}

}  // namespace
}  // namespace cellist::test
