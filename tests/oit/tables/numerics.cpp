// SPDX-License-Identifier: MIT
// Measures what docs/numerics.md says of numbers at their limits, and writes it into the tables
// there: between "<!-- measured: NAME -->" and "<!-- end of measured -->".
#include "oit/support/numerics.hpp"

#include <fstream>
#include <iostream>
#include <iterator>
#include <string>

#include "command_line.hpp"
#include "input_error.hpp"

namespace {

using namespace cellist::test;

std::string colour_table(const cellist::Device& device) {
    std::string table =
        "| extreme | layers | format | bound | largest error | undecided pixels, error |\n"
        "|---|---|---|---|---|---|\n";
    for (const Extreme& extreme : extremes)
        for (const auto& [format, name] : oit::node_formats) {
            const ColourMetrics metrics = measure(device, extreme, format);
            table += colour_line(extreme, name, metrics) + short_number(metrics.error) + " | " +
                     (metrics.undecided == 0 ? std::string("none")
                                             : std::to_string(metrics.undecided) + ", " +
                                                   short_number(metrics.undecided_error)) +
                     " |\n";
        }
    return table;
}

std::string depth_table(const cellist::Device& device) {
    std::string table =
        "| depth | at 10^-3 | at 1 | at 10^2 | at 10^4 | at 10^6 | largest error |\n"
        "|---|---|---|---|---|---|---|\n";
    for (const DepthCase& depth_case : depth_cases) {
        const DepthMetrics metrics = measure(device, depth_case);
        table += depth_line(depth_case, metrics) + short_number(metrics.used) + " of the bound |\n";
    }
    return table;
}

// The text with a table in the place of the old one.
std::string with_table(const std::string& text, const std::string& name, const std::string& table) {
    const std::string begin = "<!-- measured: " + name + " -->\n", end = "<!-- end of measured -->";
    const std::size_t at = text.find(begin);
    const std::size_t stop = at == std::string::npos ? at : text.find(end, at);
    if (stop == std::string::npos)
        throw support::InputError("the document has no place for the table '" + name + "'");
    return text.substr(0, at + begin.size()) + table + text.substr(stop);
}

}  // namespace

int main(int count, char** arguments) {
    return support::run_program("cellist-oit-numerics", [&] {
        if (count != 2) throw support::InputError("usage: cellist-oit-numerics DOCUMENT.md");
        std::ifstream in(arguments[1], std::ios::binary);
        std::string text{std::istreambuf_iterator<char>(in), {}};
        const cellist::Device device = cellist::Device::choose();
        text = with_table(text, "device",
                          device.info().name + ", driver " + device.info().driver + "\n");
        text = with_table(text, "colours", colour_table(device));
        text = with_table(text, "depths", depth_table(device));
        std::ofstream out(arguments[1], std::ios::binary);
        out << text;
        out.close();
        if (!out) throw support::InputError(std::string("cannot write '") + arguments[1] + "'");
        std::cout << "wrote the tables of " << arguments[1] << '\n';
        return true;
    });
}
