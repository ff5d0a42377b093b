// SPDX-License-Identifier: MIT
// Sources and compilers' logs of any content. Input: 'k' and what stands in a comment, a message
// and the name of a kernel that is built; or a text for the functions that take sources and logs
// apart.
#include <cerrno>
#include <regex>
#include <vector>

#include <cellist/kernel.hpp>

#include "device/program_text.hpp"
#include "input.hpp"

namespace cellist::fuzz {
namespace {

using detail::ProgramText;

/// Texts without the lines' ends, and the ends.
std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> parts(1);
    for (const char c : text) {
        if (c == '\r' || c == '\n') {
            parts.emplace_back(1, c);
            parts.emplace_back();
        } else {
            parts.back() += c;
        }
    }
    return parts;
}

/// The source without the library's includes. Lines are short enough for std::regex, which follows
/// a line by recursion.
std::string expected_source(const std::string& text, bool& uses_glm) {
    static const std::regex include(
        "^[ \t]*#[ \t]*include[ \t]*[<\"]cellist/(lists|glm)\\.clh[>\"]");
    std::string out;
    for (const std::string& line :
         lines_of(text.starts_with("\xEF\xBB\xBF") ? text.substr(3) : text)) {
        std::smatch match;
        if (std::regex_search(line, match, include)) {
            uses_glm = uses_glm || match[1] == "glm";
            out += match.suffix();
        } else {
            out += line;
        }
    }
    return out;
}

/// What the places "<kernel>:N" of a log become where the text has two parts of two lines, each
/// behind the line that names it: lines 1 to 3 and 4 to 6.
std::string expected_log(const std::string& log) {
    const bool has_kernel = log.find("<kernel>:") != std::string::npos;
    const std::regex place(has_kernel ? "<kernel>:([0-9]+)" : "input\\.cl:([0-9]+)");
    std::string out;
    auto rest = log.begin();
    for (std::sregex_iterator match(log.begin(), log.end(), place), end; match != end; ++match) {
        errno = 0;
        const std::uint64_t line = std::strtoull((*match)[1].str().c_str(), nullptr, 10);
        if (errno == ERANGE || line == 0) continue;
        out.append(rest, (*match)[0].first);
        rest = (*match)[0].second;
        out +=
            line < 4 ? "first:" + std::to_string(line - 1) : "second:" + std::to_string(line - 4);
    }
    return out.append(rest, log.end());
}

/// The name behind the first prefix that has one.
std::string expected_name(const std::string& prefix, const std::string& text) {
    std::smatch match;
    return std::regex_search(text, match, std::regex(prefix + "(\\w+)")) ? match[1].str() : "";
}

void compare_functions(const std::string& text) {
    const auto known = [](const std::string&) { return false; };
    if (text.size() > 1024) {
        bool uses_glm = false;
        const std::string source = detail::without_library_includes(text, uses_glm);
        CELLIST_FUZZ_REQUIRE(source.size() <= text.size());
        CELLIST_FUZZ_REQUIRE(detail::with_hints(text, known).starts_with(text));
        return;
    }
    bool uses_glm = false, expects_glm = false;
    const std::string source = detail::without_library_includes(text, uses_glm);
    CELLIST_FUZZ_REQUIRE(source == expected_source(text, expects_glm));
    CELLIST_FUZZ_REQUIRE(uses_glm == expects_glm);

    ProgramText program;
    program.add("1\n2", "first");
    program.add("1\n2", "second");
    CELLIST_FUZZ_REQUIRE(program.text() == "#line 1 \"first\"\n1\n2\n#line 1 \"second\"\n1\n2\n");
    CELLIST_FUZZ_REQUIRE(program.in_parts(text) == expected_log(text));

    for (const std::string prefix : {"cellist_node_", "cellist_key_"})
        CELLIST_FUZZ_REQUIRE(detail::name_after(prefix, text) == expected_name(prefix, text));
    for (const ProgramText::Complaint& error : program.errors(text, "second"))
        CELLIST_FUZZ_REQUIRE(error.line == "1" || error.line == "2" || error.line.empty() ||
                             error.line == "#line 1 \"second\"");
    const std::string hints = detail::with_hints(text, known);
    CELLIST_FUZZ_REQUIRE(hints.starts_with(text));
    CELLIST_FUZZ_REQUIRE((hints != text) == (!expected_name("cellist_node_", text).empty() ||
                                             !expected_name("cellist_key_", text).empty()));
}

/// Builds a kernel whose source holds the text where any text is allowed.
void build(Input& input) {
    bool is_new = false;
    const Device& on = device(is_new);
    const std::size_t where = input.below(5);
    std::string text = input.rest();
    // A line is continued behind a backslash, and behind the trigraph for one.
    for (char& c : text)
        if (c == '\n' || c == '\r' || c == '\\' || c == '?' || c == '\0') c = '_';
    Source source{.text = "kernel void nothing(uint parameter) {}\n"};
    std::string name = "nothing";
    bool builds = true;
    if (where == 0) {
        source.text = "// " + text + "\n" + source.text;
    } else if (where == 1) {
        source.text += "#error " + text + "\n";
        builds = false;
    } else if (where == 2) {
        source.file_name = text;
    } else if (where == 3) {
        builds = text == name;
        name = text;
    } else {
        source.text = std::string(200'000, text.empty() ? ' ' : text[0]) + source.text;
        source.text = "//" + source.text.insert(200'000, "\n");
    }
    try {
        Kernel(on, source, name);
        CELLIST_FUZZ_REQUIRE(builds);
    } catch (const OpenClError& error) {
        CELLIST_FUZZ_REQUIRE(!builds);
        CELLIST_FUZZ_REQUIRE(!error.log().empty());
    }
}

}  // namespace
}  // namespace cellist::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size > 0 && data[0] == 'k') {
        cellist::fuzz::Input input(data + 1, size - 1);
        cellist::fuzz::build(input);
    } else {
        cellist::fuzz::compare_functions({reinterpret_cast<const char*>(data), size});
    }
    return 0;
}
