// SPDX-License-Identifier: MIT
// The README and docs/ quote code from programs that are compiled and run. A line
// `<!-- code: path -->` precedes each block of C++ or OpenCL C and names its file. The file must
// contain the block's lines in sequence, apart from indentation.

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "support/catch.hpp"

namespace {

namespace fs = std::filesystem;

std::vector<std::string> trimmed_lines(const fs::path& path) {
    std::ifstream file(path);
    std::vector<std::string> lines;
    for (std::string line; std::getline(file, line);) {
        line.erase(0, line.find_first_not_of(" \t"));
        line.erase(line.find_last_not_of(" \t\r") + 1);
        lines.push_back(line);
    }
    return lines;
}

struct Block {
    std::string source;  ///< the file that the block names; empty if it names none
    std::size_t line;
    std::vector<std::string> code;
};

std::vector<Block> code_blocks(const fs::path& path) {
    std::vector<Block> blocks;
    const std::vector<std::string> lines = trimmed_lines(path);
    for (std::size_t i = 0; i < lines.size(); ++i) {
        if (lines[i] != "```cpp" && lines[i] != "```c") continue;
        Block block{"", i + 1, {}};
        const std::string mark = "<!-- code: ";
        if (i > 0 && lines[i - 1].rfind(mark, 0) == 0)
            block.source =
                lines[i - 1].substr(mark.size(), lines[i - 1].find(" -->") - mark.size());
        for (++i; i < lines.size() && lines[i] != "```"; ++i) block.code.push_back(lines[i]);
        blocks.push_back(block);
    }
    return blocks;
}

std::vector<fs::path> documents() {
    const fs::path root = CELLIST_SOURCE_DIR;
    std::vector<fs::path> paths{root / "README.md"};
    for (const auto& entry : fs::directory_iterator(root / "docs"))
        if (entry.path().extension() == ".md") paths.push_back(entry.path());
    return paths;
}

}  // namespace

TEST_CASE("every block of code in the documentation is quoted from a program", "[docs]") {
    std::size_t blocks = 0;
    for (const fs::path& document : documents()) {
        for (const Block& block : code_blocks(document)) {
            INFO(document.filename().string()
                 << ", line " << block.line << ", quoted from '" << block.source << "'");
            const auto lines = trimmed_lines(fs::path(CELLIST_SOURCE_DIR) / block.source);
            const auto found =
                std::search(lines.begin(), lines.end(), block.code.begin(), block.code.end());
            CHECK(found != lines.end());
            ++blocks;
        }
    }
    CHECK(blocks >= 10);
}
