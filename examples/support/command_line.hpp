#pragma once

#include <concepts>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include <cellist/options.hpp>

namespace CLI {
class App;
}

namespace support {

/// Reads a command line into the options of `app`. Returns the help text where it asks for it.
/// Throws InputError, with one line, where it cannot be read.
[[nodiscard]] std::optional<std::string> parse_command_line(CLI::App& app, int count,
                                                            const char* const* arguments);

/// The text of an option as a whole number. Throws InputError unless least <= number <= most.
[[nodiscard]] std::uint64_t read_number(const std::string& option, const std::string& text,
                                        std::uint64_t least, std::uint64_t most);

/// "linked", "counted" or "fixed". Throws InputError at anything else.
[[nodiscard]] cellist::Storage read_storage(const std::string& option, const std::string& text);
[[nodiscard]] std::string to_string(cellist::Storage storage);

/// Throws InputError: the option has none of the values it could have, such as "open or periodic".
[[noreturn]] void refuse(const std::string& option, const std::string& text,
                         const std::string& expected);

/// Throws InputError unless a file can be written there: the folder exists and the path is not a folder
/// itself.
void check_output_path(const std::filesystem::path& path);

/// What main of an example does: prints errors in one line, behind the program's name. The exit
/// code is 0, or 1 where `program` threw or found a difference and returned false.
int run_program(const std::string& name, std::predicate auto&& program);

/// Prints `message` behind the program's name, without what follows its first line.
void print_error(const std::string& name, const std::string& message);

}  // namespace support

// ---- implementation

#include <exception>

int support::run_program(const std::string& name, std::predicate auto&& program) {
    try {
        return program() ? 0 : 1;
    } catch (const std::exception& error) {
        print_error(name, error.what());
        return 1;
    }
}
