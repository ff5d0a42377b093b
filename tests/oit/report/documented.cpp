// SPDX-License-Identifier: MIT
// docs/transparency.md has every method, every scene and every option that there is.
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "methods/method.hpp"
#include "oit/support/program.hpp"
#include "scene/scenes.hpp"

namespace cellist::test {
namespace {

std::string transparency_document() { return read_file(CELLIST_TRANSPARENCY_DOCUMENT); }

// The rows of the first table after a heading, without the line of names.
std::vector<std::string> rows_after(const std::string& text, const std::string& heading) {
    std::istringstream lines(text.substr(text.find("\n" + heading + "\n")));
    std::vector<std::string> rows;
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with('|'))
            rows.push_back(line);
        else if (!rows.empty())
            break;
    }
    REQUIRE(rows.size() > 2);
    rows.erase(rows.begin(), rows.begin() + 2);
    return rows;
}

// The cells of a row that the table of methods tells: name, sizes, and whether it is exact.
std::string cells_of(const oit::MethodInfo& method) {
    std::string sizes;
    for (const std::uint32_t size : method.sizes)
        sizes += (sizes.empty() ? "" : ", ") + std::to_string(size);
    return "| `" + std::string(method.name) + "` | " + (sizes.empty() ? "–" : sizes) + " | " +
           (method.exact ? "yes" : "no") + " | ";
}

TEST_CASE("the document has the table of methods") {
    const std::vector<std::string> rows = rows_after(transparency_document(), "## Methods");
    REQUIRE(rows.size() == oit::methods().size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const std::string expected = cells_of(oit::methods()[i]);
        INFO(rows[i] << "\nis to begin with\n" << expected);
        CHECK(rows[i].starts_with(expected));
    }
}

TEST_CASE("the document has all scenes") {
    const std::string text = transparency_document();
    for (const oit::SceneInfo& scene : oit::scenes()) {
        INFO(scene.name);
        CHECK(contains(text, scene.name.starts_with("extreme-")
                                 ? "`extreme-…`"
                                 : "`" + std::string(scene.name) + "`"));
    }
}

TEST_CASE("the document has all options of the programs") {
    const std::string text = transparency_document();
    const std::regex option("--[a-z][a-z-]*");
    for (const char* path : {CELLIST_OIT_PROGRAM, CELLIST_TRADEOFF_PROGRAM}) {
        const std::string help = Program(path).run("--help").out;
        std::set<std::string> names;
        for (std::sregex_iterator at(help.begin(), help.end(), option), end; at != end; ++at)
            names.insert(at->str());
        CHECK(names.size() > 10);
        for (const std::string& name : names) {
            INFO(name);
            CHECK(std::regex_search(text, std::regex(name + "[^a-z-]")));
        }
    }
}

}  // namespace
}  // namespace cellist::test
