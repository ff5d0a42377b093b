// SPDX-License-Identifier: MIT
// Sources include the library's headers without a path, and their errors have the user's own lines.
#include <filesystem>
#include <fstream>
#include <string>

#include "device/program_text.hpp"
#include "support/errors.hpp"
#include "support/inserts.hpp"

namespace cellist::test {
namespace {

constexpr auto insert_one = R"(
kernel void insert_one(CELLIST_LISTS(Item, lists))
{
    Item item = { 1.0f, 7 };
    cellist_insert(lists, 2, item);
}
)";

TEST_CASE("#line directives in a source name the places of a log that counts whole lines") {
    detail::ProgramText program;
    program.add("a\n#line 40 \"mine.cl\"\nb\nc\n # line 7\nd", "user.cl");
    program.add("e", "library.cl");
    // Whole lines: 1 #line, 2 a, 3 #line, 4 b, 5 c, 6 #line, 7 d, 8 #line, 9 e.
    const auto place = [&](int line) {
        return program.in_parts("<kernel>:" + std::to_string(line) + ":1: error: x");
    };
    CHECK(place(2) == "user.cl:1:1: error: x");
    CHECK(place(4) == "mine.cl:40:1: error: x");
    CHECK(place(5) == "mine.cl:41:1: error: x");
    CHECK(place(7) == "mine.cl:7:1: error: x");
    CHECK(place(9) == "library.cl:1:1: error: x");
    const auto errors = program.errors("mine.cl:41:1: error: x", "mine.cl");
    REQUIRE(errors.size() == 1);
    CHECK(errors[0].line == "c");
}

TEST_CASE("the include line of the library may be written in any way") {
    Lists<Item> lists(device(), {5});
    for (const std::string include :
         {"", "#include <cellist/lists.clh>\n", "#include<cellist/lists.clh>\n",
          "#include \"cellist/lists.clh\"\n", "  #   include \t <cellist/lists.clh>   \n",
          "\t#\tinclude\t<cellist/lists.clh>\t// the library\n",
          "#include <cellist/lists.clh> /* twice */\n#include <cellist/lists.clh>\n",
          "#include <cellist/lists.clh>\r\n", "\xEF\xBB\xBF",
          "\xEF\xBB\xBF#include <cellist/lists.clh>\r\n", "// #include <cellist/lists.clh>\n",
          "/* as in\n#include <cellist/lists.clh>\n*/\n",
          "/* header */ // #include <cellist/lists.clh>\n#include <cellist/lists.clh>\n",
          "#ifdef __OPENCL_VERSION__\n#include <cellist/lists.clh>\n#endif\n",
          "#include <cellist/glm.clh>\n#include <cellist/lists.clh>\n",
          "constant int include = 1;\n#include <cellist/lists.clh>\n"}) {
        INFO(include);
        Kernel kernel(device(), include + insert_one, "insert_one", lists);
        require_complete(lists.build(kernel, 1), 1);
    }
}

/// Where the compiler's log mentions the line of a file: "name:line".
bool mentions(const OpenClError& error, const std::string& file_name, int line) {
    return contains(error.log(), file_name + ":" + std::to_string(line) + ":") ||
           contains(error.log(), file_name + "(" + std::to_string(line) + ")") ||
           contains(error.log(), file_name + "\":" + std::to_string(line));
}

TEST_CASE("a source that does not compile ends in an error with the user's file and line") {
    const Lists<Item> lists(device(), {5});
    const Source source{.text =
                            "// line 1\n"
                            "#include <cellist/lists.clh>\n"
                            "/* a comment\n"
                            "   of two lines */\n"
                            "kernel void broken(CELLIST_LISTS(Item, lists))\n"
                            "{\n"
                            "    uint cell = no_such_function(3);\n"
                            "}\n",
                        .file_name = "splat.cl"};
    const auto error = error_of<OpenClError>([&] { Kernel(device(), source, "broken", lists); });
    INFO(error.what());
    REQUIRE(error.call() == "clBuildProgram");
    REQUIRE(error.code() == CL_BUILD_PROGRAM_FAILURE);
    REQUIRE(contains(error.log(), "no_such_function"));
    REQUIRE(mentions(error, "splat.cl", 7));
    REQUIRE(contains(error.what(), "CL_BUILD_PROGRAM_FAILURE"));
    REQUIRE(contains(error.what(), error.log()));
}

TEST_CASE("a kernel of a struct that it does not know ends in a hint") {
    const auto error = error_of<OpenClError>(
        [] { Kernel(device(), "kernel void f(global const Item* items) {}", "f"); });
    REQUIRE(contains(error.log(), "name cellist::type<Item> in the constructor"));
}

TEST_CASE("the line of an error does not depend on the includes and types before it") {
    const Lists<Item> lists(device(), {5});
    for (const std::string before :
         {"", "#include <cellist/lists.clh>\n",
          "\n\n#include <cellist/glm.clh>\n#include <cellist/lists.clh>\n"}) {
        const Source source{.text = before + "kernel void broken(void) { oops; }\n",
                            .file_name = "my kernel.cl"};
        const auto error =
            error_of<OpenClError>([&] { Kernel(device(), source, "broken", lists); });
        INFO(error.what());
        REQUIRE(mentions(error, "my kernel.cl", 1 + static_cast<int>(count_of(before, "\n"))));
    }
}

TEST_CASE("sources and logs of any length and content end in a kernel or in the library's error") {
    constexpr auto kernel = "kernel void nothing(uint parameter) {}\n";
    const std::string blanks(1 << 20, ' '), name(1 << 18, 'a');
    for (const std::string& text :
         {blanks, "//" + blanks + "\n", blanks + "#" + blanks + "include <cellist/lists.clh>\n",
          "//#include <cellist/" + name + "\n"})
        Kernel(device(), text + kernel, "nothing");
    for (const std::string& text : {"cellist_node_" + name, "cellist_key_" + name,
                                    "cellist_layout_of_" + name, "<kernel>:" + std::string(99, '9'),
                                    std::string("<kernel>:0 <kernel>: <kernel>:x cellist_node_")}) {
        const auto error =
            error_of([&] { Kernel(device(), "#error " + text + "\n" + kernel, "nothing"); });
        REQUIRE_FALSE(std::string(error.what()).empty());
    }
}

TEST_CASE("the name of a file may have any characters") {
    for (const std::string& name : {std::string("a \"quoted\" name"), std::string("back\\slash\\"),
                                    std::string("two\nlines"), std::string("nul\0x", 5)}) {
        INFO(name);
        const Source source{.text = "kernel void broken(void) { oops; }\n", .file_name = name};
        const auto error = error_of<OpenClError>([&] { Kernel(device(), source, "broken"); });
        INFO(error.what());
        REQUIRE(contains(error.log(), "oops"));
        Kernel(device(), Source{.text = "kernel void good(uint parameter) {}", .file_name = name},
               "good");
    }
}

TEST_CASE("an unknown kernel name is an error") {
    const Lists<Item> lists(device(), {5});
    const auto error = error_of([&] { Kernel(device(), insert_one, "insert_two", lists); });
    INFO(error.what());
    REQUIRE(contains(error.what(), "CL_INVALID_KERNEL_NAME"));
    REQUIRE(contains(error.what(), "has no kernel called 'insert_two'"));
    REQUIRE(contains(error.what(), "its kernels: insert_one"));
    const auto of_two = error_of([] {
        Kernel(device(), "kernel void first(uint x) {} kernel void second(uint x) {}", "third");
    });
    INFO(of_two.what());
    const bool in_order = contains(of_two.what(), "its kernels: first, second");
    REQUIRE((in_order || contains(of_two.what(), "its kernels: second, first")));
    const auto of_none = error_of([] { Kernel(device(), "int f(int x) { return x; }", "f"); });
    INFO(of_none.what());
    REQUIRE(contains(of_none.what(), "'f'"));
}

TEST_CASE("a kernel gives its OpenCL kernel and the log of its build") {
    const Kernel silent(device(), "kernel void f(uint x, global uint* out) { *out = x; }", "f");
    INFO(silent.log());
    // Intel's driver reports each step of a build.
    if (device().info().platform == "Intel(R) OpenCL")
        REQUIRE_FALSE(contains(silent.log(), "warning"));
    else
        REQUIRE(silent.log().empty());
    REQUIRE(silent.cl().getInfo<CL_KERNEL_NUM_ARGS>() == 2);
    const Source source{.text = "// a line\n#warning look here\nkernel void g(uint x) {}",
                        .file_name = "warns.cl"};
    const Kernel warns(device(), source, "g");
    INFO(warns.log());
    REQUIRE(contains(warns.log(), "warns.cl:2:"));
    REQUIRE(contains(warns.log(), "look here"));
}

TEST_CASE("options reach the compiler") {
    const Buffer<cl_uint> out(device(), 1);
    const std::string text = "kernel void answer(global uint* out) { *out = ANSWER; }";
    for (const cl_uint answer : {42u, 43u}) {
        Kernel kernel(device(),
                      Source{.text = text, .options = "-DANSWER=" + std::to_string(answer)},
                      "answer");
        kernel.run(1, out);
        REQUIRE(out.download()[0] == answer);
    }
}

TEST_CASE("no macro of the library is variadic as in C99, which NVIDIA's compiler refuses") {
    const std::filesystem::path root = CELLIST_SOURCE_DIR "/kernels";
    int files = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root)) {
        if (!entry.is_regular_file()) continue;
        ++files;
        std::ifstream file(entry.path());
        int number = 0;
        for (std::string line; std::getline(file, line);) {
            ++number;
            INFO(entry.path().string() << ":" << number << ": " << line);
            const bool defines = line.starts_with("#define");
            REQUIRE_FALSE((defines && contains(line, "(...)")));
            REQUIRE_FALSE((defines && contains(line, ", ...)")));
            REQUIRE_FALSE(contains(line, "__VA_ARGS__"));
        }
    }
    REQUIRE(files > 20);
}

TEST_CASE("several kernels come from one source") {
    Lists<Item> lists(device(), {5});
    const std::string text = std::string("#include <cellist/lists.clh>\n") + insert_one + R"(
kernel void count(CELLIST_LISTS(Item, lists), global uint* count)
{
    cellist_for_each(lists, 2, node) ++*count;
}
)";
    Kernel insert(device(), text, "insert_one", lists);
    Kernel count(device(), text, "count", lists);
    REQUIRE(insert.name() == "insert_one");
    REQUIRE(count.name() == "count");
    Buffer<cl_uint> out(device(), 1);
    out.fill(0);
    lists.build(insert, 144);
    count.run(1, lists, out);
    REQUIRE(out.download()[0] == 144);
}

}  // namespace
}  // namespace cellist::test
