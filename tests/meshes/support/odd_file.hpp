// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "input_error.hpp"
#include "meshes/support/plain.hpp"
#include "oit/support/files.hpp"
#include "support/catch.hpp"

namespace cellist::test {

using Random = std::mt19937;

/// 0 to count - 1.
inline unsigned below(Random& random, unsigned count) {
    return static_cast<unsigned>(random() % count);
}

/// True once in `in` times.
inline bool once_in(Random& random, unsigned in) { return below(random, in) == 0; }

template <class T>
const T& one_of(Random& random, const std::vector<T>& values) {
    return values[random() % values.size()];
}

template <class T>
void shuffle(Random& random, std::vector<T>& values) {
    for (std::size_t i = values.size(); i > 1; --i) std::swap(values[i - 1], values[random() % i]);
}

/// A mesh file in one of the layouts of its format.
struct OddFile {
    std::string name;    ///< with the extension
    std::string layout;  ///< for messages
    std::string bytes;
};

/// Loads the file. Empty if it gives the plain mesh without drops, else a text that says how it
/// differs.
inline std::string problem_of_whole(const Folder& folder, const OddFile& file,
                                    const PlainMesh& plain) {
    try {
        const support::Mesh mesh = support::load_mesh(folder.write(file.name, file.bytes));
        if (mesh.drops.triangles() > 0) return "faces were dropped";
        return difference(mesh, plain);
    } catch (const support::InputError& error) {
        return error.what();
    }
}

inline void require_one_line(const std::string& message, const std::string& name) {
    INFO(message);
    REQUIRE(message.find('\n') == std::string::npos);
    REQUIRE(message.find(name) != std::string::npos);
}

/// Cuts the file after `size` bytes. It must be refused in one line, give the plain mesh, or report
/// that it may be cut or that faces were dropped.
inline std::string problem_of_cut(const Folder& folder, const OddFile& file, std::size_t size,
                                  const PlainMesh& plain) {
    const std::string name = "cut-" + file.name;
    try {
        const support::Mesh mesh =
            support::load_mesh(folder.write(name, file.bytes.substr(0, size)));
        if (mesh.ends_within_line || mesh.drops.triangles() > 0) return "";
        return difference(mesh, plain);
    } catch (const support::InputError& error) {
        require_one_line(error.what(), name);
        return "";
    }
}

/// Cuts the file at every line's end, and at some random bytes.
inline void check_cuts(const Folder& folder, const OddFile& file, const PlainMesh& plain,
                       Random& random, std::size_t random_cuts) {
    std::vector<std::size_t> sizes;
    for (std::size_t i = 0; i < file.bytes.size(); ++i)
        if (file.bytes[i] == '\n' || file.bytes[i] == '\r') sizes.insert(sizes.end(), {i, i + 1});
    for (std::size_t i = 0; i < random_cuts; ++i) sizes.push_back(random() % file.bytes.size());
    for (const std::size_t size : sizes) {
        const std::string problem = problem_of_cut(folder, file, size, plain);
        INFO(file.layout << ", cut after " << size << " of " << file.bytes.size() << " bytes");
        CHECK(problem == "");
    }
}

/// Changes random bytes. The file must be refused in one line, or give a mesh that can be drawn.
inline void check_flips(const Folder& folder, const OddFile& file, Random& random,
                        std::size_t count) {
    const std::string name = "flipped-" + file.name;
    for (std::size_t i = 0; i < count; ++i) {
        std::string bytes = file.bytes;
        for (unsigned flips = 1 + below(random, 3); flips > 0; --flips)
            bytes[random() % bytes.size()] = static_cast<char>(random() % 256);
        try {
            const support::Mesh mesh = support::load_mesh(folder.write(name, bytes));
            REQUIRE(mesh.normals.size() == mesh.positions.size());
            bool good = true;
            for (const auto& t : mesh.triangles)
                for (const std::uint32_t v : t)
                    good = good && v < mesh.positions.size() &&
                           std::isfinite(glm::length(glm::dvec3(mesh.positions[v]))) &&
                           std::abs(glm::length(mesh.normals[v]) - 1) < 1e-4F;
            REQUIRE(good);
        } catch (const support::InputError& error) {
            require_one_line(error.what(), name);
        }
    }
}

/// A number in one of the many notations of text files, exact for multiples of 1/64.
inline std::string number_text(Random& random, double value) {
    char text[64];
    switch (random() % 6) {
        case 0:
            std::snprintf(text, sizeof text, "%.9g", value);
            break;
        case 1:
            std::snprintf(text, sizeof text, "%.8f", value);
            break;
        case 2:
            std::snprintf(text, sizeof text, "%+.10e", value);
            break;
        case 3:
            std::snprintf(text, sizeof text, "%.7E", value);
            break;
        case 4:
            std::snprintf(text, sizeof text, "%+.6f", value);
            break;
        default: {
            // ".5", "-.5"
            std::snprintf(text, sizeof text, "%.6f", value);
            std::string short_text = text;
            const std::size_t zero = short_text.find("0.");
            if (zero == 0 || (zero == 1 && text[0] == '-')) short_text.erase(zero, 1);
            return short_text;
        }
    }
    return text;
}

}  // namespace cellist::test
