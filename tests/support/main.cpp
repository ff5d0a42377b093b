// SPDX-License-Identifier: MIT
#define CELLIST_TESTS_MAIN
#include <exception>
#include <iostream>
#include <optional>
#include <set>
#include <string>

#include "support/catch.hpp"
#include "support/device.hpp"
#include "support/skip.hpp"
#if __has_include(<catch2/reporters/catch_reporter_event_listener.hpp>)
#include <catch2/interfaces/catch_interfaces_capture.hpp>
#include <catch2/reporters/catch_reporter_event_listener.hpp>
#include <catch2/reporters/catch_reporter_registrars.hpp>
#endif

namespace {

#if __has_include(<catch2/reporters/catch_reporter_event_listener.hpp>)
using Listener = Catch::EventListenerBase;
#else
using Listener = Catch::TestEventListenerBase;
#endif

std::optional<cellist::Device> shared_device;
std::set<std::string> skips;  // "test case: reason"
bool has_run = false;         // some test case has asserted something

class Assertions : public Listener {
public:
    using Listener::Listener;
    void testCaseEnded(const Catch::TestCaseStats& stats) override {
        has_run = has_run || stats.totals.assertions.total() > 0;
    }
};
CATCH_REGISTER_LISTENER(Assertions)

}  // namespace

const cellist::Device& cellist::test::device() {
    if (!shared_device) {
        shared_device = Device::choose();
        const DeviceInfo& info = shared_device->info();
        std::cout << "device: " << info.name << ", " << info.platform << ", driver " << info.driver
                  << std::endl;
    }
    return *shared_device;
}

void cellist::test::note_skip(const std::string& reason) {
    skips.insert(Catch::getResultCapture().getCurrentTestName() + ": " + reason);
}

int main(int argument_count, char** arguments) {
    const int failed = Catch::Session().run(argument_count, arguments);
    // Here and not after main, when the driver may be gone already.
    shared_device.reset();
    for (const std::string& skip : skips) std::cout << "skipped: " << skip << std::endl;
    if (failed != 0) return 1;
    return skips.empty() || has_run ? 0 : cellist::test::skipped_exit_code;
}
