#pragma once

#include <concepts>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <cellist/options.hpp>

namespace CLI {
class App;
}

namespace support {

/// Reads a command line into the options of `app`, and adds --version. Returns the text to print if the
/// command line asks for help or the version. Throws InputError, with one line, if it is invalid.
[[nodiscard]] std::optional<std::string> parse_command_line(CLI::App& app, int count,
                                                            const char* const* arguments);

/// The version of the programs, as --version prints it: "0.1.0".
[[nodiscard]] std::string_view version();

/// The text of an option as a whole number. Throws InputError unless least <= number <= most.
[[nodiscard]] std::uint64_t read_number(const std::string& option, const std::string& text,
                                        std::uint64_t least, std::uint64_t most);

/// "linked", "counted" or "fixed". Throws InputError at anything else.
[[nodiscard]] cellist::Storage read_storage(const std::string& option, const std::string& text);

/// Throws InputError: the option has none of the values it could have, such as "open or periodic".
[[noreturn]] void refuse(const std::string& option, const std::string& text,
                         const std::string& expected);

/// An option that has no effect, or contradicts another one, if `applies` is true.
struct IdleOption {
    const char* name;
    bool applies;
    std::string message;
};

/// Throws InputError with the message of the first of these options that was given and applies.
void refuse_idle_options(const CLI::App& app, std::span<const IdleOption> table);

/// The body of an example's main(): prints errors in one line, after the program's name. Returns the exit
/// code: 1 if `program` threw, returned false because it found a difference, or printed output that could
/// not be written; else 0.
int run_program(const std::string& name, std::predicate auto&& program);

/// Prints the first line of `message` after the program's name.
void print_error(const std::string& name, const std::string& message);

}  // namespace support

// ---- implementation

#include <exception>

#include "files.hpp"

int support::run_program(const std::string& name, std::predicate auto&& program) {
    prepare_output();
    try {
        const bool is_good = program();
        flush_standard_output();
        return is_good ? 0 : 1;
    } catch (const OutputClosed&) {
        return 1;
    } catch (const std::exception& error) {
        print_error(name, error.what());
        return 1;
    }
}
