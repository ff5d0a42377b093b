// SPDX-License-Identifier: MIT
// The file in which `cellist tune` keeps what it measured: whatever else stands in its place counts
// as none.
#include <filesystem>
#include <fstream>
#include <iostream>

#include <sys/stat.h>

#include "device/profile.hpp"
#include "support/cache.hpp"
#include "support/errors.hpp"
#include "support/inserts.hpp"

namespace cellist::test {
namespace {

namespace fs = std::filesystem;
using detail::Pattern;
using detail::Profile;

DeviceInfo some_device() {
    DeviceInfo info;
    info.name = "A device (TM) / 2";
    info.platform = "Some platform";
    info.driver = "1.2+3";
    return info;
}

Profile some_profile() {
    Profile profile(123'456);
    double seconds = 1e-9;
    for (const Storage storage : detail::choices)
        for (const Pattern pattern : detail::patterns) {
            profile.set_cost(storage, pattern, {seconds, 2 * seconds});
            seconds *= 3;
        }
    return profile;
}

void require_equal(const Profile& a, const Profile& b) {
    REQUIRE(a.records() == b.records());
    for (const Storage storage : detail::choices)
        for (const Pattern pattern : detail::patterns) {
            const auto close = [](double x, double y) { return std::abs(x - y) < 1e-12; };
            REQUIRE(close(a.cost(storage, pattern).build_seconds,
                          b.cost(storage, pattern).build_seconds));
            REQUIRE(close(a.cost(storage, pattern).read_seconds,
                          b.cost(storage, pattern).read_seconds));
        }
}

TEST_CASE("a profile is read as it was written") {
    const std::string text = profile_text(some_device(), some_profile());
    const auto read = detail::parse_profile(some_device(), text);
    REQUIRE(read.has_value());
    require_equal(*read, some_profile());

    Profile extreme(1);
    extreme.set_cost(Storage::linked, Pattern::random, {0, 1e9});
    REQUIRE(detail::parse_profile(some_device(), profile_text(some_device(), extreme)));
}

TEST_CASE("a text that is not whole, or has another byte, is no profile or a good one") {
    const DeviceInfo device = some_device();
    const std::string text = profile_text(device, some_profile());
    int refused = 0;
    for (std::size_t size = 0; size < text.size(); ++size) {
        REQUIRE_FALSE(detail::parse_profile(device, text.substr(0, size)).has_value());
        ++refused;
    }
    REQUIRE_FALSE(detail::parse_profile(device, text + "end\n").has_value());
    REQUIRE_FALSE(detail::parse_profile(device, text + std::string(1, '\0')).has_value());
    for (std::size_t at = 0; at < text.size(); ++at)
        for (const char c : std::string("\0\n\r -+.,0e9x\xFF", 14)) {
            if (c == text[at]) continue;
            std::string other = text;
            other[at] = c;
            const auto profile = detail::parse_profile(device, other);
            if (!profile) {
                ++refused;
                continue;
            }
            // Another digit in a number.
            REQUIRE(std::isdigit(static_cast<unsigned char>(text[at])));
            REQUIRE(std::isdigit(static_cast<unsigned char>(c)));
            for (const Storage storage : detail::choices)
                for (const Pattern pattern : detail::patterns) {
                    const detail::Cost& cost = profile->cost(storage, pattern);
                    for (const double seconds : {cost.build_seconds, cost.read_seconds})
                        REQUIRE((seconds > 0 && seconds <= 1));
                }
        }
    std::cout << "profile: " << refused << " damaged texts refused" << std::endl;
}

TEST_CASE("numbers that are no costs are refused") {
    const DeviceInfo device = some_device();
    const std::string text = profile_text(device, some_profile());
    const std::string first = "linked coherent build_ps 1000 ";
    REQUIRE(contains(text, first));
    for (const std::string number :
         {"0", "-1", "+1", "1000000000001", "18446744073709551616", "1e3", "0x10", "nan", "inf", "",
          " 7", "1.5", "99999999999999999999999999999999999999999999"}) {
        INFO(number);
        std::string other = text;
        other.replace(other.find(first), first.size(), "linked coherent build_ps " + number + " ");
        REQUIRE_FALSE(detail::parse_profile(device, other).has_value());
    }
}

TEST_CASE("the profile of another device, platform or driver is none") {
    const std::string text = profile_text(some_device(), some_profile());
    for (std::string DeviceInfo::*member :
         {&DeviceInfo::name, &DeviceInfo::platform, &DeviceInfo::driver}) {
        DeviceInfo other = some_device();
        other.*member += "1";
        REQUIRE_FALSE(detail::parse_profile(other, text).has_value());
        (other.*member).clear();
        REQUIRE_FALSE(detail::parse_profile(other, text).has_value());
    }
    // Names of more than one line.
    DeviceInfo device = some_device();
    device.name = "a\nrecords 5\r\n";
    require_equal(detail::parse_profile(device, profile_text(device, some_profile())).value(),
                  some_profile());
}

TEST_CASE("the file lies in the user's cache directory, under a plain name") {
    const Variable home("HOME", "/home/somebody");
    {
        const Variable cache("XDG_CACHE_HOME", "/var/cache/me");
        REQUIRE(detail::profile_path(some_device()) ==
                "/var/cache/me/cellist/A_device__TM____2-Some_platform-1.2_3.profile");
        DeviceInfo device = some_device();
        device.name = "../../etc/passwd\n" + std::string(1000, 'x');
        const fs::path path = detail::profile_path(device);
        REQUIRE(path.parent_path() == "/var/cache/me/cellist");
        REQUIRE(path.filename().string().size() < 255);
    }
    for (const char* no_path : {static_cast<const char*>(nullptr), "", "relative/path"}) {
        const Variable cache("XDG_CACHE_HOME", no_path);
        REQUIRE(detail::profile_path(some_device()).parent_path() ==
                "/home/somebody/.cache/cellist");
        const Variable no_home("HOME", no_path);
        REQUIRE(contains(error_of([] { (void)detail::profile_path(some_device()); }).what(),
                         "XDG_CACHE_HOME or HOME"));
        REQUIRE_FALSE(detail::load_profile(some_device()).has_value());
        REQUIRE_THROWS_AS(detail::save_profile(some_device(), some_profile()), Error);
    }
}

TEST_CASE("a file is written whole, and what is no file of ours is not read") {
    const CacheDirectory cache;
    const DeviceInfo device = some_device();
    const fs::path file = detail::profile_path(device);
    REQUIRE_FALSE(detail::load_profile(device).has_value());
    detail::save_profile(device, some_profile());
    require_equal(detail::load_profile(device).value(), some_profile());
    Profile other = some_profile();
    other.set_cost(Storage::fixed, Pattern::random, {1, 1});
    detail::save_profile(device, other);
    require_equal(detail::load_profile(device).value(), other);
    // Nothing else is left there.
    REQUIRE(std::distance(fs::directory_iterator(file.parent_path()), fs::directory_iterator()) ==
            1);

    const auto write = [&](const std::string& text) {
        std::ofstream(file, std::ios::binary) << text;
        REQUIRE_FALSE(detail::load_profile(device).has_value());
    };
    write("");
    write("hello\n");
    write(profile_text(device, other) + std::string(1 << 20, ' '));
    std::string head = profile_text(device, other);
    head.resize(head.size() - 4);
    write(head);

    // A pipe that nobody writes to must not block, nor a file without end be read.
    fs::remove(file);
    REQUIRE(mkfifo(file.c_str(), 0600) == 0);
    REQUIRE_FALSE(detail::load_profile(device).has_value());
    fs::remove(file);
    fs::create_symlink("/dev/zero", file);
    REQUIRE_FALSE(detail::load_profile(device).has_value());
    fs::remove(file);
    fs::create_symlink(file, file);
    REQUIRE_FALSE(detail::load_profile(device).has_value());
    fs::remove(file);
    fs::create_directory(file);
    REQUIRE_FALSE(detail::load_profile(device).has_value());
    // A directory in the file's place cannot be replaced.
    std::ofstream(file / "inside") << "x";
    const Error error = error_of([&] { detail::save_profile(device, some_profile()); });
    REQUIRE(contains(error.what(), "cannot write"));
    REQUIRE(std::distance(fs::directory_iterator(file.parent_path()), fs::directory_iterator()) ==
            1);
}

TEST_CASE("a directory that cannot be made is named") {
    const CacheDirectory cache;
    std::ofstream(cache.path / "cellist") << "a file";
    const Error error = error_of([&] { detail::save_profile(some_device(), some_profile()); });
    REQUIRE(
        contains(error.what(), "cannot make the directory " + (cache.path / "cellist").string()));
    REQUIRE_FALSE(detail::load_profile(some_device()).has_value());
}

TEST_CASE("containers of a Device start from its profile") {
    const CacheDirectory cache;
    const ListsOptions options{.storage = Storage::automatic};
    const Device without = Device::choose();
    REQUIRE(contains(Lists<Item>(without, {10}, options).storage_reason(), "run cellist tune"));

    Profile profile(1 << 20);
    for (const Storage storage : detail::choices)
        for (const Pattern pattern : detail::patterns)
            profile.set_cost(storage, pattern, {storage == Storage::counted ? 1e-9 : 2e-9, 1e-9});
    detail::save_profile(without.info(), profile);
    // Read once for each Device.
    REQUIRE(Lists<Item>(without, {10}, options).storage() == Storage::linked);
    const Device with = Device::choose();
    const Lists<Item> lists(with, {10}, options);
    INFO(lists.storage_reason());
    REQUIRE(lists.storage() == Storage::counted);
    REQUIRE(contains(lists.storage_reason(), "profile"));

    std::ofstream(detail::profile_path(with.info())) << "nonsense";
    const Device damaged = Device::choose();
    REQUIRE(contains(Lists<Item>(damaged, {10}, options).storage_reason(), "run cellist tune"));
}

}  // namespace
}  // namespace cellist::test
