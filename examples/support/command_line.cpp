// SPDX-License-Identifier: MIT
#include "command_line.hpp"

#include <array>
#include <charconv>
#include <deque>
#include <iostream>
#include <utility>

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

cellist::Storage read_storage(const std::string& text) {
    std::string names;
    for (const auto storage : cellist::all_storages) {
        if (text == name_of(storage)) return storage;
        names += (names.empty() ? "" : " or ") + std::string(name_of(storage));
    }
    refuse("--storage", text, names);
}

// The fewest digits that are read as this number again.
std::string shortest(double number) {
    std::array<char, 32> digits{};
    const auto [end, error] = std::to_chars(digits.begin(), digits.end(), number);
    return {digits.begin(), end};
}

template <class Number>
std::optional<Number> parsed(const std::string& text) {
    Number number{};
    const char* const end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, number);
    if (error != std::errc() || stop != end) return {};
    return number;
}

}  // namespace

struct CommandLine::Parser {
    CLI::App app;
    std::deque<std::string> texts;  // of options, which CLI11 refers to
    std::vector<std::string> arguments;
    std::vector<std::function<void()>> reads, checks;
};

CommandLine::CommandLine(const std::string& program, const std::string& description)
    : parser_(std::make_unique<Parser>()) {
    parser_->app.name(program);
    parser_->app.description(description);
}

CommandLine::~CommandLine() = default;

void CommandLine::add(const std::string& name, const std::string& text, const std::string& what,
                      const std::string& type, Read read) {
    std::string& stored = parser_->texts.emplace_back(text);
    CLI::Option* option = parser_->app.add_option(name, stored, what)->type_name(type);
    if (!text.empty()) option->capture_default_str();
    parser_->reads.emplace_back([&stored, read = std::move(read)] {
        if (!stored.empty()) read(stored);
    });
}

void CommandLine::add_flag(const std::string& name, bool& value, const std::string& what) {
    parser_->app.add_flag(name, value, what);
}

void CommandLine::add_arguments(const std::string& name, const std::string& what,
                                const std::string& type,
                                std::function<void(const std::vector<std::string>&)> read) {
    parser_->app.add_option(name, parser_->arguments, what)->type_name(type);
    parser_->reads.emplace_back([this, read = std::move(read)] { read(parser_->arguments); });
}

void CommandLine::add_real(const std::string& name, double& value, double least, double most,
                           const std::string& what, const std::string& type) {
    add(name, shortest(value), what, type, [&value, name, least, most](const std::string& text) {
        value = read_between(name, text, least, most,
                             "a number from " + shortest(least) + " to " + shortest(most));
    });
}

void CommandLine::add_storage(cellist::Storage& storage) {
    add("--storage", name_of(storage), "storage of the lists", "linked|counted|fixed",
        [&](const std::string& text) { storage = read_storage(text); });
}

void CommandLine::add_storage(std::optional<cellist::Storage>& storage) {
    add("--storage", "", "storage of the lists; the default is the fastest on the device",
        "linked|counted|fixed", [&](const std::string& text) { storage = read_storage(text); });
}

void CommandLine::add_seed(std::uint32_t& seed) {
    add_number("--seed", seed, 0, 0xFFFFFFFF, "seed of the random numbers");
}

void CommandLine::add_device(std::string& device) {
    add_text(
        "--device", device,
        "device, by index or part of its name; the default is CELLIST_DEVICE, a GPU, or the first",
        "D");
}

void CommandLine::add_check(std::function<void()> check) {
    parser_->checks.push_back(std::move(check));
}

void CommandLine::add_footer(const std::string& text) { parser_->app.footer(text); }

std::optional<std::string> CommandLine::parse(int count, const char* const* arguments) {
    CLI::App& app = parser_->app;
    app.set_version_flag("--version", app.get_name() + " " + std::string(version()),
                         "print the version");
    try {
        app.parse(count, arguments);
    } catch (const CLI::CallForHelp&) {
        return app.help();
    } catch (const CLI::CallForVersion& version) {
        return std::string(version.what()) + "\n";
    } catch (const CLI::ExtrasError& error) {
        throw InputError(first_line(error.what()) + meant_option(app) + " (see --help)");
    } catch (const CLI::ParseError& error) {
        throw InputError(first_line(error.what()) + " (see --help)");
    }
    // Most likely a variable of the shell that is not set.
    for (const CLI::Option* option : app.get_options())
        for (const std::string& value : option->results())
            if (value.empty()) throw InputError(option->get_name() + ": the value is empty");
    for (const auto& read : parser_->reads) read();
    for (const auto& check : parser_->checks) check();
    return {};
}

void CommandLine::refuse_idle(std::span<const IdleOption> table) const {
    for (const IdleOption& option : table)
        if (option.applies && parser_->app.count(option.name) > 0) throw InputError(option.message);
}

std::string_view version() { return CELLIST_VERSION; }

void refuse(const std::string& option, const std::string& text, const std::string& expected) {
    throw InputError(option + " " + text + ": expected " + expected);
}

std::uint64_t read_number(const std::string& option, const std::string& text, std::uint64_t least,
                          std::uint64_t most) {
    const auto number = parsed<std::uint64_t>(text);
    if (!number || *number < least || *number > most)
        refuse(option, text,
               "a whole number from " + std::to_string(least) + " to " + std::to_string(most));
    return *number;
}

double read_between(const std::string& option, const std::string& text, double least, double most,
                    const std::string& expected) {
    const auto number = parsed<double>(text);
    if (!number || !(*number >= least && *number <= most)) refuse(option, text, expected);
    return *number;
}

std::uint64_t read_bytes(const std::string& option, const std::string& text) {
    constexpr std::pair<std::string_view, int> units[] = {
        {"KiB", 10}, {"MiB", 20}, {"GiB", 30}, {"", 0}};
    for (const auto& [unit, shift] : units) {
        if (!std::string_view(text).ends_with(unit)) continue;
        const auto number = parsed<std::uint64_t>(text.substr(0, text.size() - unit.size()));
        if (!number || *number == 0 || *number > ~std::uint64_t{0} >> shift) break;
        return *number << shift;
    }
    refuse(option, text, "a whole number of bytes, KiB, MiB or GiB, such as 64MiB");
}

void refuse_mpi() {
    throw InputError(
        "this program was built without MPI, so there is no --mpi: install libopenmpi-dev, "
        "configure "
        "and build again");
}

void print_error(const std::string& name, const std::string& message) {
    std::cerr << name << ": " << first_line(message) << '\n';
}

}  // namespace support
