// SPDX-License-Identifier: MIT
// The ranks of a host take the devices that CELLIST_DEVICE names in turn. ctest starts this test
// with two devices of PoCL that have different names.
#include <cstdlib>
#include <optional>

#include "mpi/ranks.hpp"
#include "support/catch.hpp"

using namespace cellist;
using namespace cellist::test;

namespace {

/// CELLIST_DEVICE while this exists.
class Selector {
public:
    explicit Selector(const std::string& value) {
        if (const char* const known = std::getenv("CELLIST_DEVICE")) before_ = known;
        setenv("CELLIST_DEVICE", value.c_str(), 1);
    }
    ~Selector() {
        if (before_)
            setenv("CELLIST_DEVICE", before_->c_str(), 1);
        else
            unsetenv("CELLIST_DEVICE");
    }
    Selector(const Selector&) = delete;
    Selector& operator=(const Selector&) = delete;

private:
    std::optional<std::string> before_;
};

/// The names of the devices of a platform.
std::vector<std::string> names_in(const std::string& platform) {
    std::vector<std::string> names;
    for (const DeviceInfo& info : Device::all())
        if (info.platform == platform) names.push_back(info.name);
    return names;
}

}  // namespace

TEST_CASE("the ranks of a host take the devices of CELLIST_DEVICE in turn") {
    const std::string platform = Device::all().front().platform;
    const std::vector<std::string> names = names_in(platform);
    with_all_counts([&](MPI_Comm comm, int ranks) {
        int rank = 0;
        MPI_Comm_rank(comm, &rank);
        INFO("rank " << rank << " of " << ranks << ", " << names.size() << " devices");
        const auto chosen = [&](const std::string& selector) {
            const Selector selects(selector);
            return mpi::choose(comm).info().name;
        };
        const auto turn = static_cast<std::size_t>(rank);
        CHECK(chosen(platform) == names[turn % names.size()]);
        // An index and a full name name one device.
        CHECK(chosen("0") == names[0]);
        CHECK(chosen(names.back()) == names.back());
        // Ranks with other values take no turns.
        CHECK(chosen(rank % 2 == 0 ? "0" : platform) ==
              names[rank % 2 == 0 ? 0 : turn / 2 % names.size()]);
        const std::string refusal = common_error(comm, [&] { chosen("no such device"); });
        CHECK(refusal.find("no device is called 'no such device'") != std::string::npos);
    });
}
