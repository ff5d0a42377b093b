// SPDX-License-Identifier: MIT
#include "device/program_text.hpp"

#include <algorithm>
#include <charconv>
#include <iterator>
#include <optional>
#include <utility>

namespace cellist::detail {

namespace {

constexpr std::string_view digits = "0123456789";
constexpr std::string_view name_characters =
    "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZ_abcdefghijklmnopqrstuvwxyz";

/// The longest part from `at` on that consists of `characters`.
std::string_view run(std::string_view text, std::size_t at, std::string_view characters) {
    return text.substr(at, text.find_first_not_of(characters, at) - at);
}

/// Takes `expected` from the begin of the text; false if it does not stand there.
bool take(std::string_view& text, std::string_view expected) {
    if (!text.starts_with(expected)) return false;
    text.remove_prefix(expected.size());
    return true;
}

void skip_blanks(std::string_view& text) {
    while (text.starts_with(' ') || text.starts_with('\t')) text.remove_prefix(1);
}

/// NAME if the text starts with `#include <cellist/NAME.clh>`, which is taken from it; else empty.
std::string_view take_library_include(std::string_view& text) {
    std::string_view rest = text;
    skip_blanks(rest);
    if (!take(rest, "#")) return {};
    skip_blanks(rest);
    if (!take(rest, "include")) return {};
    skip_blanks(rest);
    if (!take(rest, "<") && !take(rest, "\"")) return {};
    if (!take(rest, "cellist/")) return {};
    const std::string_view name = run(rest, 0, name_characters);
    rest.remove_prefix(name.size());
    if (!take(rest, ".clh") || (!take(rest, ">") && !take(rest, "\""))) return {};
    text = rest;
    return name;
}

/// A directive `#line NUMBER "FILE"`, whose file name is optional.
struct LineDirective {
    std::size_t number = 0;
    std::string file_name;
};

std::optional<LineDirective> line_directive(std::string_view line) {
    LineDirective directive;
    skip_blanks(line);
    if (!take(line, "#")) return {};
    skip_blanks(line);
    if (!take(line, "line")) return {};
    skip_blanks(line);
    const std::string_view number = run(line, 0, digits);
    if (std::from_chars(number.data(), number.data() + number.size(), directive.number).ec !=
        std::errc())
        return {};
    line.remove_prefix(number.size());
    skip_blanks(line);
    if (take(line, "\"")) directive.file_name = line.substr(0, line.find('"'));
    return directive;
}

/// The source without line continuations, which may be anywhere in a directive.
std::string spliced(std::string_view text) {
    std::string out;
    for (std::size_t at = 0; at < text.size(); ++at) {
        const std::string_view rest = text.substr(at);
        const std::size_t escape = rest.starts_with('\\') ? 1
                                   : rest.starts_with(
                                         "?"
                                         "?/")
                                       ? 3
                                       : 0;
        if (escape != 0) {
            // Compilers allow blanks between the backslash and the end of the line.
            const std::size_t end = rest.find_first_not_of(" \t\v\f", escape);
            if (end != std::string_view::npos && (rest[end] == '\n' || rest[end] == '\r')) {
                at += end;
                if (rest.substr(end).starts_with("\r\n")) ++at;
                continue;
            }
        }
        out += text[at];
    }
    return out;
}

/// Skips blanks and comments within a directive.
void skip_space(std::string_view& text) {
    for (;;) {
        text.remove_prefix(std::min(text.find_first_not_of(" \t\v\f"), text.size()));
        if (!text.starts_with("/*")) return;
        text.remove_prefix(std::min(text.find("*/", 2), text.size() - 2) + 2);
    }
}

}  // namespace

bool includes_files(std::string_view source, std::string_view options) {
    for (const std::string_view option : {"-include", "-imacros"})
        if (options.find(option) != std::string_view::npos) return true;
    const std::string text = spliced(source);
    for (std::size_t at = text.find_first_of("#%?"); at != std::string::npos;
         at = text.find_first_of("#%?", at + 1)) {
        std::string_view rest = std::string_view(text).substr(at);
        if (!take(rest, "#") && !take(rest, "%:") &&
            !take(rest,
                  "?"
                  "?="))
            continue;
        skip_space(rest);
        for (const std::string_view directive : {"include", "import", "embed"})
            if (rest.starts_with(directive)) return true;
    }
    return false;
}

void ProgramText::add(std::string_view part, const std::string& file_name) {
    parts_.push_back({lines_ + 1, 1, file_name});
    std::string escaped;
    for (const char c : file_name) {
        if (c == '"' || c == '\\') escaped += '\\';
        escaped += static_cast<unsigned char>(c) < ' ' ? '_' : c;
    }
    append("#line 1 \"" + escaped + "\"\n");
    std::size_t line = lines_;
    for (std::string_view rest = part; !rest.empty();) {
        const std::string_view text = rest.substr(0, rest.find('\n'));
        rest.remove_prefix(std::min(text.size() + 1, rest.size()));
        ++line;
        if (auto directive = line_directive(text))
            parts_.push_back({line, directive->number,
                              directive->file_name.empty() ? parts_.back().file_name
                                                           : std::move(directive->file_name)});
    }
    append(part);
    append("\n");
}

void ProgramText::add(const ProgramText& other) {
    for (const Part& part : other.parts_)
        parts_.push_back({lines_ + part.line, part.first, part.file_name});
    text_ += other.text_;
    lines_ += other.lines_;
}

std::string ProgramText::in_parts(std::string_view log) const {
    // Not where a part has such a name.
    const bool has_input = std::any_of(parts_.begin(), parts_.end(), [](const Part& part) {
        return part.file_name.ends_with("input.cl");
    });
    const std::string_view place =
        log.find("<kernel>:") == std::string_view::npos && !has_input ? "input.cl:" : "<kernel>:";
    std::string out;
    std::size_t rest = 0;
    for (std::size_t at = log.find(place); at != std::string_view::npos; at = log.find(place, at)) {
        const std::size_t begin = at;
        at += place.size();
        const std::string_view number = run(log, at, digits);
        std::size_t line = 0;
        const auto parsed = std::from_chars(number.data(), number.data() + number.size(), line);
        const auto after = std::find_if(parts_.begin(), parts_.end(),
                                        [&](const Part& part) { return part.line > line; });
        if (parsed.ec != std::errc() || after == parts_.begin()) continue;
        const Part& part = *std::prev(after);
        out += log.substr(rest, begin - rest);
        out += part.file_name + ":" + std::to_string(part.first + line - part.line - 1);
        rest = at += number.size();
    }
    return out.append(log.substr(rest));
}

std::vector<ProgramText::Complaint> ProgramText::errors(std::string_view log,
                                                        const std::string& file_name) const {
    std::vector<Complaint> found;
    const auto part = std::find_if(parts_.begin(), parts_.end(), [&](const Part& candidate) {
        return candidate.file_name == file_name;
    });
    if (part == parts_.end()) return found;
    std::string_view text = text_;
    for (std::size_t line = 1; line < part->line; ++line)
        text.remove_prefix(std::min(text.find('\n'), text.size() - 1) + 1);
    while (!log.empty()) {
        const std::string_view message = log.substr(0, log.find('\n'));
        log.remove_prefix(std::min(message.size() + 1, log.size()));
        // "FILE:LINE:COLUMN: error: ...", and PoCL's "error: FILE:LINE:COLUMN: ..."
        std::string_view rest = message;
        take(rest, "error: ");
        if (!take(rest, file_name) || !take(rest, ":")) continue;
        if (message.find("error: ") == std::string_view::npos) continue;
        const std::string_view number = run(rest, 0, digits);
        std::size_t line = 0;
        std::from_chars(number.data(), number.data() + number.size(), line);
        std::string_view complained = text;
        line = line < part->first ? 0 : line - part->first + 1;
        for (; line > 0 && !complained.empty(); --line)
            complained.remove_prefix(std::min(complained.find('\n'), complained.size() - 1) + 1);
        found.push_back({message, complained.substr(0, complained.find('\n'))});
    }
    return found;
}

void ProgramText::append(std::string_view part) {
    text_ += part;
    lines_ += static_cast<std::size_t>(std::count(part.begin(), part.end(), '\n'));
}

std::string without_library_includes(std::string_view text, bool& uses_glm) {
    std::string out;
    take(text, "\xEF\xBB\xBF");  // a byte order mark, which compilers skip at the start alone
    while (!text.empty()) {
        std::string_view line = text;
        const std::string_view name = take_library_include(line);
        if (name == "lists" || name == "glm") {
            uses_glm = uses_glm || name == "glm";
            text = line;
        }
        // find_first_of() calls a function for each character, and every new Kernel comes here.
        const auto end =
            std::find_if(text.begin(), text.end(), [](char c) { return c == '\n' || c == '\r'; });
        const auto length = std::min(static_cast<std::size_t>(end - text.begin()) + 1, text.size());
        out += text.substr(0, length);
        text.remove_prefix(length);
    }
    return out;
}

std::vector<std::string> defined_macros(std::string_view options) {
    std::vector<std::string> names;
    for (std::size_t at = options.find("-D"); at != std::string_view::npos;
         at = options.find("-D", at)) {
        const bool begins =
            at == 0 || std::string_view(" \t\"'").find(options[at - 1]) != std::string_view::npos;
        at += 2;
        if (!begins) continue;
        at = std::min(options.find_first_not_of(" \t\"'", at), options.size());
        const std::string_view name = run(options, at, name_characters);
        if (name.empty() || digits.find(name[0]) != std::string_view::npos) continue;
        if (name.starts_with("CELLIST_") || name.starts_with("__") || name.starts_with("cl_"))
            continue;
        names.emplace_back(name);
    }
    return names;
}

std::string name_after(std::string_view prefix, std::string_view text) {
    for (std::size_t at = text.find(prefix); at != std::string_view::npos;
         at = text.find(prefix, at)) {
        at += prefix.size();
        const std::string_view name = run(text, at, name_characters);
        if (!name.empty()) return std::string(name);
    }
    return {};
}

std::string with_hints(std::string log, const std::function<bool(const std::string&)>& known) {
    std::string record = name_after("cellist_node_", log);
    if (known(record)) record.clear();
    const std::string key = name_after("cellist_key_", log);
    if (!record.empty())
        log += "\nhint: name a Lists<" + record + "> or cellist::type<" + record +
               "> in the constructor of the Kernel, so that it knows the type";
    const std::string type = name_after("unknown type name '", log);
    if (!type.empty() && record.empty())
        log += "\nhint: if '" + type + "' is an adapted struct, name cellist::type<" + type +
               "> in the constructor of the Kernel";
    if (log.find("ptxas") != std::string::npos && log.find("near '}'") != std::string::npos)
        log += "\nhint: NVIDIA's compiler fails at kernels without parameters; give each one";
    if (log.find("'cellist_order'") != std::string::npos)
        log += "\nhint: the value of a sort expression is an integer or a float";
    if (!key.empty() && record.empty())
        log += "\nhint: '" + key + "' is no scalar member of an adapted struct";
    return log;
}

}  // namespace cellist::detail
