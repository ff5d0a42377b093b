#define CELLIST_TESTS_MAIN
#include <exception>
#include <iostream>
#include <optional>

#include "support/catch.hpp"
#include "support/device.hpp"

namespace {

std::optional<cellist::Device> shared_device;

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

int main(int argument_count, char** arguments) {
    const int failed = Catch::Session().run(argument_count, arguments);
    // Here and not after main, when the driver may be gone already.
    shared_device.reset();
    return failed;
}
