// SPDX-License-Identifier: MIT
// Runs a target on the files of folders, without a fuzzer: replay NAME FOLDER...
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <vector>

#include "input.hpp"

int main(int count, char** arguments) {
    if (count < 3) {
        std::cerr << "usage: " << arguments[0] << " NAME FOLDER...\n";
        return 2;
    }
    std::vector<std::filesystem::path> paths;
    for (int i = 2; i < count; ++i)
        for (const auto& entry : std::filesystem::directory_iterator(arguments[i]))
            paths.push_back(entry.path());
    std::sort(paths.begin(), paths.end());
    for (const std::filesystem::path& path : paths) {
        std::cerr << path.filename().string() << std::endl;  // the last one, if it ends here
        std::ifstream file(path, std::ios::binary);
        const std::vector<char> bytes((std::istreambuf_iterator<char>(file)), {});
        LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
    }
    std::cout << "fuzz: " << arguments[1] << ": " << paths.size() << " inputs\n";
    return paths.empty() ? 1 : 0;
}
