// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <string>

#include "input_error.hpp"
#include "mesh.hpp"
#include "oit/support/files.hpp"
#include "support/errors.hpp"

namespace cellist::test {

/// The mesh of a file with this name and text.
inline support::Mesh load_text(const std::string& name, const std::string& text) {
    const Folder folder;
    return support::load_mesh(folder.write(name, text));
}

/// The message of the error that refuses the file. Checks that it is one line that names the file.
inline std::string refusal(const std::string& name, const std::string& text) {
    const auto error = error_of<support::InputError>([&] { (void)load_text(name, text); });
    const std::string message = error.what();
    INFO(message);
    REQUIRE(contains(message, name));
    REQUIRE(!contains(message, "\n"));
    return message;
}

inline bool has_note(const support::Mesh& mesh, const std::string& part) {
    return std::any_of(mesh.notes.begin(), mesh.notes.end(),
                       [&](const std::string& note) { return contains(note, part); });
}

}  // namespace cellist::test
