// SPDX-License-Identifier: MIT
#pragma once

#include <concepts>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <cellist/options.hpp>

namespace support {

/// The version of the programs, as --version prints it: "0.1.0".
[[nodiscard]] std::string_view version();

/// The text of an option as a whole number. Throws InputError unless least <= number <= most.
[[nodiscard]] std::uint64_t read_number(const std::string& option, const std::string& text,
                                        std::uint64_t least, std::uint64_t most);

/// The same for any number; `expected` describes it, such as "a number from 0 to 1".
[[nodiscard]] double read_between(const std::string& option, const std::string& text, double least,
                                  double most, const std::string& expected);

/// The text of an option as a number of bytes, such as 67108864 or 64MiB. Throws InputError unless
/// it is at least 1.
[[nodiscard]] std::uint64_t read_bytes(const std::string& option, const std::string& text);

/// Throws InputError: the option has none of the values it could have, such as "open or periodic".
[[noreturn]] void refuse(const std::string& option, const std::string& text,
                         const std::string& expected);

/// An option that has no effect, or contradicts another one, if `applies` is true.
struct IdleOption {
    const char* name;
    bool applies;
    std::string message;
};

/// The options of a program. Each is added with its default and where its value goes; parse() reads
/// all of them, in the order in which they were added.
class CommandLine {
public:
    /// What reads and checks the text of an option.
    using Read = std::function<void(const std::string& text)>;

    CommandLine(const std::string& program, const std::string& description);
    ~CommandLine();
    CommandLine(const CommandLine&) = delete;
    CommandLine& operator=(const CommandLine&) = delete;

    /// An option whose text `read` reads. An empty default is not read. `type` describes the text
    /// in the help.
    void add(const std::string& name, const std::string& text, const std::string& what,
             const std::string& type, Read read);
    /// An option that is text, a path or a positional argument.
    template <class Text>
    void add_text(const std::string& name, Text& value, const std::string& what,
                  const std::string& type) {
        add(name, Text(value), what, type, [&value](const std::string& text) { value = text; });
    }
    void add_flag(const std::string& name, bool& value, const std::string& what);
    /// Any number of positional arguments.
    void add_arguments(const std::string& name, const std::string& what, const std::string& type,
                       std::function<void(const std::vector<std::string>&)> read);
    /// A whole number.
    template <std::integral Number>
    void add_number(const std::string& name, Number& value, std::uint64_t least, std::uint64_t most,
                    const std::string& what, const std::string& type = "N") {
        add(name, std::to_string(value), what, type,
            [&value, name, least, most](const std::string& text) {
                value = static_cast<Number>(read_number(name, text, least, most));
            });
    }
    /// Any number.
    void add_real(const std::string& name, double& value, double least, double most,
                  const std::string& what, const std::string& type);
    /// --storage linked|counted|fixed
    void add_storage(cellist::Storage& storage);
    /// The same, where the program chooses if the option is not given.
    void add_storage(std::optional<cellist::Storage>& storage);
    /// --seed N
    void add_seed(std::uint32_t& seed);
    /// --device D
    void add_device(std::string& device);

    /// A check of values together, after all of them have been read.
    void add_check(std::function<void()> check);
    /// The end of the help.
    void add_footer(const std::string& text);

    /// Returns the text to print if the command line asks for help or the version. Throws
    /// InputError, with one line, if it is invalid.
    [[nodiscard]] std::optional<std::string> parse(int count, const char* const* arguments);

    /// For add_check(): throws InputError with the message of the first of these options that was
    /// given and applies.
    void refuse_idle(std::span<const IdleOption> table) const;

private:
    struct Parser;
    std::unique_ptr<Parser> parser_;
};

/// The body of an example's main(): prints errors in one line, after the program's name. Returns
/// the exit code: 1 if `program` threw, returned false because it found a difference, or printed
/// output that could not be written; else 0.
int run_program(const std::string& name, std::predicate auto&& program);

/// Throws InputError: --mpi needs a build with MPI.
[[noreturn]] void refuse_mpi();

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
