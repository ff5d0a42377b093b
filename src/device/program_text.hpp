// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace cellist::detail {

// Sources and compilers' logs have any length, so they are scanned in one pass, without recursion.

/// A program's text, put together from parts, and which lines come from which.
class ProgramText {
public:
    void add(std::string_view part, const std::string& file_name);
    void add(const ProgramText& other);

    [[nodiscard]] const std::string& text() const { return text_; }

    /// A compiler's log with the names and lines of the parts, and of the #line directives in them.
    /// NVIDIA's compiler and Oclgrind do not follow #line: they count the lines of the whole text
    /// and name it "<kernel>" and "input.cl".
    [[nodiscard]] std::string in_parts(std::string_view log) const;

    /// An error of such a log.
    struct Complaint {
        std::string_view message;
        std::string_view line;  ///< of the text, that the compiler complains about
    };
    /// The errors in the part of this name, in the log's order.
    [[nodiscard]] std::vector<Complaint> errors(std::string_view log,
                                                const std::string& file_name) const;

private:
    struct Part {
        std::size_t line;   ///< of its #line, in the whole text
        std::size_t first;  ///< the number that its #line gives to the next line
        std::string file_name;
    };

    void append(std::string_view part);

    std::string text_;
    std::size_t lines_ = 0;
    std::vector<Part> parts_;
};

/// Removes a byte order mark and the library's own #include lines from a source, since the
/// library's text is already in front of it. Keeps the line numbers. Sets `uses_glm` if
/// <cellist/glm.clh> was among the lines.
[[nodiscard]] std::string without_library_includes(std::string_view text, bool& uses_glm);

/// The macros that build options define with -D, except those that belong to the library or the
/// compiler.
[[nodiscard]] std::vector<std::string> defined_macros(std::string_view options);

/// Whether a program may include other files: by a directive anywhere in its source, or by an
/// option. Also true for some sources that only look like it, for example in a comment.
[[nodiscard]] bool includes_files(std::string_view source, std::string_view options);

/// The letters, digits and underscores after the first `prefix` that has any; empty if none has.
[[nodiscard]] std::string name_after(std::string_view prefix, std::string_view text);

/// A log that mentions names which users never wrote, and what caused them. `known` tells whether
/// the program knows a struct of a name.
[[nodiscard]] std::string with_hints(std::string log,
                                     const std::function<bool(const std::string&)>& known);

}  // namespace cellist::detail
