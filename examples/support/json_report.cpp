// SPDX-License-Identifier: MIT
#include "json_report.hpp"

#include <array>
#include <cmath>
#include <ctime>

#include "command_line.hpp"
#include "files.hpp"

namespace support {
namespace {

using nlohmann::ordered_json;

// ISO 8601, in UTC.
std::string now() {
    const std::time_t time = std::time(nullptr);
    std::tm parts{};
    gmtime_r(&time, &parts);
    std::array<char, 32> text{};
    std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &parts);
    return text.data();
}

std::string quoted(const std::string& text) {
    if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
    std::string field = "\"";
    for (const char c : text) field += c == '"' ? std::string("\"\"") : std::string(1, c);
    return field + '"';
}

std::string field_of(const ordered_json& value) {
    if (value.is_null()) return {};
    return quoted(value.is_string() ? value.get<std::string>() : value.dump());
}

}  // namespace

ordered_json report_head(int schema, std::string_view program,
                         std::span<const std::string> arguments) {
    ordered_json json{{"schema", schema}, {"program", program}, {"version", version()}};
    json["arguments"] = ordered_json::array();
    for (const std::string& argument : arguments) json["arguments"].push_back(text_of(argument));
    json["date"] = now();
    return json;
}

ordered_json finite_or_null(double value) {
    return std::isfinite(value) ? ordered_json(value) : ordered_json(nullptr);
}

ordered_json file_or_null(const std::filesystem::path& path) {
    return path.empty() ? ordered_json(nullptr) : ordered_json(text_of(path));
}

std::string dump(const ordered_json& json, int indent) {
    return json.dump(indent, ' ', false, ordered_json::error_handler_t::replace);
}

std::string csv(std::span<const char* const> names, const ordered_json& objects) {
    std::string text;
    for (const char* name : names) text += std::string(text.empty() ? "" : ",") + name;
    text += '\n';
    for (const ordered_json& object : objects) {
        std::string line;
        for (const char* name : names) {
            if (name != names[0]) line += ',';
            if (object.contains(name)) line += field_of(object[name]);
        }
        text += line + '\n';
    }
    return text;
}

}  // namespace support
