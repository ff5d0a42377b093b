// SPDX-License-Identifier: MIT
// Several threads, each with its own objects, share a Device or have one each.
#include <thread>

#include "support/inserts.hpp"

namespace cellist::test {
namespace {

/// Builds, sorts and downloads several times on a thread of its own; returns what went wrong.
std::string work(const Device& device, std::uint32_t seed) {
    try {
        std::mt19937 random(seed);
        Lists<Item> lists(device, {50}, {.capacity_nodes = 10});
        Inserter inserter(lists, device);
        for (int i = 0; i < 20; ++i) {
            const Inserts<Item> inserts = random_inserts(500u + 100u * seed, 50, random);
            const BuildReport report = inserter.build(lists, inserts);
            if (report.stored != inserts.size()) return "records are missing";
            lists.sort(&Item::key);
            if (!lists.validate().ok()) return lists.validate().message();
            const HostLists<Item> found = lists.download();
            for (std::uint64_t cell = 0; cell < 50; ++cell) {
                const auto list = found.cell(cell);
                for (std::size_t at = 0; at < list.size(); ++at) {
                    if (list[at].id >= inserts.size() || inserts.cells[list[at].id] != cell ||
                        inserts.records[list[at].id] != list[at])
                        return "a record is wrong";
                    if (at > 0 && list[at - 1].key > list[at].key) return "a list is not sorted";
                }
            }
        }
        return {};
    } catch (const std::exception& error) {
        return error.what();
    }
}

void run(const std::vector<const Device*>& devices) {
    std::vector<std::string> failures(devices.size());
    std::vector<std::thread> threads;
    for (std::size_t i = 0; i < devices.size(); ++i)
        threads.emplace_back(
            [&, i] { failures[i] = work(*devices[i], static_cast<std::uint32_t>(i)); });
    for (std::thread& thread : threads) thread.join();
    for (const std::string& failure : failures) REQUIRE(failure == "");
}

TEST_CASE("threads with their own containers share a Device") {
    run({&device(), &device(), &device(), &device()});
}

TEST_CASE("threads have a Device each") {
    const Device first = Device::choose();
    const Device second = Device::choose();
    const Device third = Device::choose();
    run({&first, &second, &third});
}

TEST_CASE("a container moves from one thread to another") {
    CELLIST_RANDOM(random, 160u);
    Lists<Item> lists(device(), {50});
    const Inserts<Item> inserts = random_inserts(144, 50, random);
    Inserter(lists).build(lists, inserts);
    HostLists<Item> found({1}, {0, 0}, {});
    std::thread([&found, lists = std::move(lists)]() mutable {
        lists.sort(&Item::key);
        found = lists.download();
    }).join();
    require_same(found, oracle_of(inserts, 50));
}

}  // namespace
}  // namespace cellist::test
