#include "command_line.hpp"

#include <charconv>
#include <iostream>
#include <vector>

#include <CLI/CLI.hpp>

#include "closest.hpp"
#include "first_line.hpp"
#include "input_error.hpp"

namespace support {
namespace {

// A suggestion for the first unknown option.
std::string meant_option(const CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::Option* option : app.get_options())
        for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    for (const std::string& argument : app.remaining())
        if (argument.starts_with("--"))
            return did_you_mean(argument.substr(0, argument.find('=')), names);
    return {};
}

}  // namespace

std::optional<std::string> parse_command_line(CLI::App& app, int count,
                                              const char* const* arguments) {
    app.set_version_flag("--version", app.get_name() + " " + std::string(version()),
                         "print the version");
    try {
        app.parse(count, arguments);
        // Most likely a variable of the shell that is not set.
        for (const CLI::Option* option : app.get_options())
            for (const std::string& value : option->results())
                if (value.empty()) throw InputError(option->get_name() + ": the value is empty");
    } catch (const CLI::CallForHelp&) {
        return app.help();
    } catch (const CLI::CallForVersion& version) {
        return std::string(version.what()) + "\n";
    } catch (const CLI::ExtrasError& error) {
        throw InputError(first_line(error.what()) + meant_option(app) + " (see --help)");
    } catch (const CLI::ParseError& error) {
        throw InputError(first_line(error.what()) + " (see --help)");
    }
    return {};
}

std::string_view version() { return CELLIST_VERSION; }

void refuse(const std::string& option, const std::string& text, const std::string& expected) {
    throw InputError(option + " " + text + ": expected " + expected);
}

void refuse_idle_options(const CLI::App& app, std::span<const IdleOption> table) {
    for (const IdleOption& option : table)
        if (option.applies && app.count(option.name) > 0) throw InputError(option.message);
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
        if (text == name_of(storage)) return storage;
    refuse(option, text, "linked, counted or fixed");
}

void print_error(const std::string& name, const std::string& message) {
    std::cerr << name << ": " << first_line(message) << '\n';
}

}  // namespace support
