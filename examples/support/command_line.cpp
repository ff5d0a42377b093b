#include "command_line.hpp"

#include <charconv>
#include <iostream>

#include <CLI/CLI.hpp>

#include "first_line.hpp"
#include "input_error.hpp"

namespace support {

std::optional<std::string> parse_command_line(CLI::App& app, int count,
                                              const char* const* arguments) {
    try {
        app.parse(count, arguments);
        // Most likely a variable of the shell that is not set.
        for (const CLI::Option* option : app.get_options())
            for (const std::string& value : option->results())
                if (value.empty()) throw InputError(option->get_name() + ": the value is empty");
    } catch (const CLI::CallForHelp&) {
        return app.help();
    } catch (const CLI::ParseError& error) {
        throw InputError(first_line(error.what()) + " (see --help)");
    }
    return {};
}

void refuse(const std::string& option, const std::string& text, const std::string& expected) {
    throw InputError(option + " " + text + ": expected " + expected);
}

std::uint64_t read_number(const std::string& option, const std::string& text, std::uint64_t least,
                          std::uint64_t most) {
    std::uint64_t number = 0;
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, number);
    if (error != std::errc() || stop != end || number < least || number > most)
        refuse(option, text,
               "a whole number from " + std::to_string(least) + " to " + std::to_string(most));
    return number;
}

cellist::Storage read_storage(const std::string& option, const std::string& text) {
    for (const auto storage :
         {cellist::Storage::linked, cellist::Storage::counted, cellist::Storage::fixed})
        if (text == to_string(storage)) return storage;
    refuse(option, text, "linked, counted or fixed");
}

std::string to_string(cellist::Storage storage) {
    switch (storage) {
        case cellist::Storage::linked:
            return "linked";
        case cellist::Storage::counted:
            return "counted";
        case cellist::Storage::fixed:
            return "fixed";
        case cellist::Storage::automatic:
            return "automatic";
    }
    return "unknown";
}

void check_output_path(const std::filesystem::path& path) {
    const std::filesystem::path folder =
        path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
    std::error_code error;
    if (path.empty()) throw InputError("the output path is empty");
    if (!std::filesystem::is_directory(folder, error))
        throw InputError("cannot write '" + path.string() + "': the folder '" + folder.string() +
                         "' does not exist");
    if (std::filesystem::is_directory(path, error))
        throw InputError("cannot write '" + path.string() + "': it is a folder");
}

void print_error(const std::string& name, const std::string& message) {
    std::cerr << name << ": " << first_line(message) << '\n';
}

}  // namespace support
