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

/// Reads a command line into the options of `app`, and into --version. Returns what is to be printed
/// where it asks for help or the version. Throws InputError, with one line, where it cannot be read.
[[nodiscard]] std::optional<std::string> parse_command_line(CLI::App& app, int count,
                                                            const char* const* arguments);

/// Of the programs, as --version prints it: "0.1.0".
[[nodiscard]] std::string_view version();

/// The text of an option as a whole number. Throws InputError unless least <= number <= most.
[[nodiscard]] std::uint64_t read_number(const std::string& option, const std::string& text,
                                        std::uint64_t least, std::uint64_t most);

/// "linked", "counted" or "fixed". Throws InputError at anything else.
[[nodiscard]] cellist::Storage read_storage(const std::string& option, const std::string& text);
[[nodiscard]] std::string to_string(cellist::Storage storage);

/// Throws InputError: the option has none of the values it could have, such as "open or periodic".
[[noreturn]] void refuse(const std::string& option, const std::string& text,
                         const std::string& expected);

/// An option that changes nothing, or contradicts another one, where `applies` is true.
struct IdleOption {
    const char* name;
    bool applies;
    std::string message;
};

/// Throws InputError with the message of the first of these that was given and applies.
void refuse_idle_options(const CLI::App& app, std::span<const IdleOption> table);

/// What main of an example does: prints errors in one line, after the program's name. The exit code
/// is 0, or 1 where `program` threw or found a difference and returned false, or where not all that it
/// printed could be written.
int run_program(const std::string& name, std::predicate auto&& program);

/// Prints `message` after the program's name, without what follows its first line.
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
