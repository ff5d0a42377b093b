// SPDX-License-Identifier: MIT
// The program `cellist`: lists the OpenCL devices of this machine, checks that cellist works on
// them, and measures its storages there.

#include <cerrno>
#include <iostream>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include <cellist/cellist.hpp>

#include "devices.hpp"
#include "selftest.hpp"
#include "tune.hpp"

namespace {

constexpr const char* usage =
    "usage: cellist devices                  list the OpenCL devices of this machine\n"
    "       cellist selftest [--device D]    check inserts, growth and sorting against the CPU\n"
    "       cellist tune [--device D]        measure the storages for Storage::automatic\n"
    "       cellist --help | --version\n"
    "\n"
    "D is an index from `cellist devices`, or part of a name. Without --device, the\n"
    "environment variable CELLIST_DEVICE names the device. Without both, cellist takes\n"
    "the first GPU, or else the first device.\n"
    "Exit status: 0 success, 1 a check failed or no device was found, 2 wrong usage.\n";

int wrong_usage(const std::string& what) {
    std::cerr << "cellist: " << what << "\n\n" << usage;
    return 2;
}

int run(const std::vector<std::string>& arguments) {
    if (arguments.empty()) return wrong_usage("no command given");
    const std::string& command = arguments[0];
    if (command == "--help" || command == "-h") {
        std::cout << usage;
        return 0;
    }
    if (command == "--version") {
        std::cout << "cellist " CELLIST_VERSION "\n";
        return 0;
    }
    if (command == "devices") {
        if (arguments.size() > 1) return wrong_usage("unknown argument '" + arguments[1] + "'");
        return cellist::command::devices(std::cout);
    }
    if (command == "selftest" || command == "tune") {
        std::optional<std::string> selector;
        for (std::size_t i = 1; i < arguments.size(); ++i) {
            if (arguments[i] == "--device" && i + 1 < arguments.size())
                selector = arguments[++i];
            else
                return wrong_usage("unknown or incomplete argument '" + arguments[i] + "'");
        }
        const cellist::Device device =
            selector ? cellist::Device::choose(*selector) : cellist::Device::choose();
        return command == "tune" ? cellist::command::tune(device, std::cout)
                                 : cellist::command::selftest(device, std::cout);
    }
    return wrong_usage("unknown command '" + command + "'");
}

}  // namespace

int main(int argc, char** argv) {
    const auto fail = [](const std::string& why) {
        std::cout.exceptions(std::ios::goodbit);  // the error stream flushes this one first
        std::cerr << "cellist: " << why << '\n';
        return 1;
    };
    try {
        // The program ends at the first write that fails, on a full disk or a closed pipe.
        std::cout.exceptions(std::ios::badbit | std::ios::failbit);
        const int status = run({argv + 1, argv + argc});
        std::cout.flush();
        return status;
    } catch (const std::ios::failure&) {
        // The exception has no reason; the last system call set errno.
        const std::error_code reason(errno, std::generic_category());
        return fail("cannot write to standard output: " + reason.message());
    } catch (const std::exception& error) {
        return fail(error.what());
    }
}
