// SPDX-License-Identifier: MIT
// `cellist selftest` takes its sizes from the device: it works on small ones, and within what they
// have.
#include <sstream>

#include "command/selftest.hpp"
#include "device/device_state.hpp"
#include "support/errors.hpp"

namespace cellist::test {
namespace {

TEST_CASE("the selftest passes on devices with little memory") {
    struct Size {
        std::uint64_t memory;
        std::uint64_t allocation;
    };
    constexpr std::uint64_t mebibyte = 1 << 20;
    for (const auto& [memory, allocation] :
         {Size{2048 * mebibyte, 1024 * mebibyte}, Size{64 * mebibyte, 16 * mebibyte},
          Size{16 * mebibyte, 1 * mebibyte}}) {
        const Device small = Device::choose();
        DeviceInfo& info = small.state()->info;
        info.global_memory_bytes = std::min(memory, info.global_memory_bytes);
        info.max_allocation_bytes = std::min(allocation, info.max_allocation_bytes);
        std::ostringstream out;
        const int status = command::selftest(small, out);
        INFO(memory << " bytes: " << out.str());
        REQUIRE(status == 0);
        REQUIRE(contains(out.str(), "cellist works on this device"));
        REQUIRE_FALSE(contains(out.str(), "FAILED"));
    }
}

}  // namespace
}  // namespace cellist::test
