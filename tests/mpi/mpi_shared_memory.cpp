// SPDX-License-Identifier: MIT
// Ranks of one host exchange the same records through memory that they share as in messages, and
// use messages if there is no room for such memory, and for other hosts.
#include <csignal>
#include <fstream>
#include <functional>
#include <optional>
#include <sstream>

#include <sys/resource.h>

#include "mpi/ranks.hpp"
#include "support/catch.hpp"
#include "support/storages.hpp"

using namespace cellist;
using namespace cellist::test;

namespace {

/// The size of the smallest part of a rank: two pieces of 64 KiB.
constexpr std::uint64_t least_part_bytes = 2 * 65536;

/// The host that a rank is on, for tests that divide the ranks of one host; empty for its own.
std::function<int(int rank)> host_of;

/// The bytes that this process shares with others through files of the library.
std::uint64_t shared_bytes() {
    std::ifstream maps("/proc/self/maps");
    std::uint64_t sum = 0;
    for (std::string line; std::getline(maps, line);) {
        if (line.find("/cellist-") == std::string::npos) continue;
        std::istringstream range(line);
        std::uint64_t first = 0, end = 0;
        char dash = 0;
        range >> std::hex >> first >> dash >> end;
        sum += end - first;
    }
    return sum;
}

/// Limits the size of files that this process makes, which shared memory counts as.
class FileSizeLimit {
public:
    explicit FileSizeLimit(rlim_t bytes) {
        std::signal(SIGXFSZ, SIG_IGN);
        getrlimit(RLIMIT_FSIZE, &before_);
        const rlimit limit{std::min(bytes, before_.rlim_max), before_.rlim_max};
        REQUIRE(setrlimit(RLIMIT_FSIZE, &limit) == 0);
    }
    ~FileSizeLimit() { setrlimit(RLIMIT_FSIZE, &before_); }
    FileSizeLimit(const FileSizeLimit&) = delete;
    FileSizeLimit& operator=(const FileSizeLimit&) = delete;

private:
    rlimit before_{};
};

/// Inserts of which rank `from` makes all, for random cells of first ... end - 1.
Inserts<Item> inserts_of_one_rank(std::size_t count, int from, int ranks, cl_uint first,
                                  cl_uint end) {
    CELLIST_RANDOM(random, 47u);
    Inserts<Item> all;
    for (std::size_t i = 0; i < count; ++i)
        for (int rank = 0; rank < ranks; ++rank)
            // A share is every `ranks`-th insert. Cell ~0 rejects those of the other ranks.
            all.add(rank == from ? first + below(random, end - first) : ~cl_uint{0},
                    {1.0f, static_cast<cl_uint>(all.size())});
    return all;
}

void check(MPI_Comm comm, const Shape& shape, const Inserts<Item>& inserts) {
    const auto oracle = oracle_of(inserts, shape.cells());
    mpi::Lists<Item> lists(device(), mpi::Partition(comm, shape));
    DistributedInserter<Item> inserter(lists, inserts);
    for (const bool shares : {true, false})
        for (const std::uint64_t bytes : {12u, 100u, 4096u, 1u << 24}) {
            INFO("memory is " << (shares ? "" : "not ") << "shared, at most " << bytes
                              << " bytes at a time");
            lists.core().set_shares_memory(shares);
            lists.core().set_message_bytes(bytes);
            require_complete(inserter.build(lists), oracle.size(), inserts.size() - oracle.size());
            require_same(lists.download(), oracle);
        }
}

}  // namespace

/// Takes the place of the function of the MPI library, which remains as PMPI_Comm_split_type.
extern "C" int MPI_Comm_split_type(MPI_Comm comm, int type, int key, MPI_Info info,
                                   MPI_Comm* parts) {
    if (!host_of) return PMPI_Comm_split_type(comm, type, key, info, parts);
    int rank = 0;
    MPI_Comm_rank(comm, &rank);
    return MPI_Comm_split(comm, host_of(rank), key, parts);
}

TEST_CASE("any number of records travels in any number of pieces") {
    CELLIST_RANDOM(random, 43u);
    const Shape shape{40};
    for (const std::size_t count : {0u, 1u, 7u, 93u, 500u}) {
        const Inserts<Item> inserts = random_inserts(count, 42, random);
        with_all_counts([&](MPI_Comm comm, int ranks) {
            INFO(ranks << " ranks, " << count << " records");
            check(comm, shape, inserts);
        });
    }
}

TEST_CASE("one rank sends all records, or gets all") {
    const Shape shape{40};
    with_all_counts([&](MPI_Comm comm, int ranks) {
        for (const int from : {0, ranks - 1}) {
            INFO(ranks << " ranks, from rank " << from);
            check(comm, shape, inserts_of_one_rank(144, from, ranks, 0, 40));
            // Cell 39 is of the last rank.
            check(comm, shape, inserts_of_one_rank(144, from, ranks, 39, 40));
        }
    });
    Inserts<Item> to_first;
    for (cl_uint i = 0; i < 300; ++i) to_first.add(0, {1.0f, i});
    with_all_counts([&](MPI_Comm comm, int) { check(comm, shape, to_first); });
}

TEST_CASE("ranks exchange records within their host and with other hosts") {
    CELLIST_RANDOM(random, 59u);
    const Shape shape{40};
    const Inserts<Item> inserts = random_inserts(500, 42, random);
    for (const bool in_turn : {false, true}) {
        host_of = [&](int rank) { return in_turn ? rank % 2 : rank / 2; };
        with_all_counts([&](MPI_Comm comm, int ranks) {
            INFO(ranks << " ranks, two on a host, or in turn on two hosts: " << in_turn);
            check(comm, shape, inserts);
            for (const int from : {0, ranks - 1})
                check(comm, shape, inserts_of_one_rank(144, from, ranks, 0, 40));
            mpi::Lists<Item> lists(device(), mpi::Partition(comm, shape));
            DistributedInserter<Item>(lists, inserts).build(lists);
            std::uint64_t on_host = 0;
            for (int rank = 0; rank < ranks; ++rank)
                if (host_of(rank) == host_of(lists.partition().rank())) ++on_host;
            REQUIRE(shared_bytes() == (on_host > 1 ? on_host * least_part_bytes : 0));
        });
        host_of = nullptr;
    }
}

TEST_CASE("memory is shared while lists exchange records, and given back") {
    CELLIST_RANDOM(random, 53u);
    const Shape shape{40};
    const Inserts<Item> inserts = random_inserts(93, 40, random);
    with_all_counts([&](MPI_Comm comm, int ranks) {
        INFO(ranks << " ranks");
        mpi::Lists<Item> messages(device(), mpi::Partition(comm, shape));
        messages.core().set_shares_memory(false);
        DistributedInserter<Item> into_messages(messages, inserts);
        into_messages.build(messages);
        REQUIRE(shared_bytes() == 0);
        {
            mpi::Lists<Item> lists(device(), mpi::Partition(comm, shape));
            REQUIRE(shared_bytes() == 0);
            DistributedInserter<Item> inserter(lists, inserts);
            inserter.build(lists);
            REQUIRE((shared_bytes() > 0) == (ranks > 1));
        }
        REQUIRE(shared_bytes() == 0);
    });
}

TEST_CASE("ranks share less memory, or send messages, where one has no room") {
    const Shape shape{40};
    Inserts<Item> inserts;
    for (cl_uint i = 0; i < 150'000; ++i) inserts.add(i % 40, {static_cast<cl_float>(i % 97), i});
    const auto oracle = oracle_of(inserts, shape.cells());
    with_all_counts([&](MPI_Comm comm, int ranks) {
        if (ranks == 1) return;
        INFO(ranks << " ranks");
        for (const rlim_t limit : {rlim_t{4096}, rlim_t{150'000}}) {
            INFO("room for " << limit << " bytes");
            mpi::Lists<Item> lists(device(), mpi::Partition(comm, shape));
            DistributedInserter<Item> inserter(lists, inserts);
            const auto build = [&] {
                require_complete(inserter.build(lists), inserts.size());
                require_same(lists.download(), oracle);
            };
            // Compiles all kernels: compilers write files.
            lists.core().set_shares_memory(false);
            for (int number = 0; number < 3; ++number) build();
            lists.core().set_shares_memory(true);
            std::optional<FileSizeLimit> has_no_room;
            if (lists.partition().rank() == ranks - 1) has_no_room.emplace(limit);
            for (int number = 0; number < 2; ++number) build();
            const std::uint64_t expected = limit < least_part_bytes ? 0 : least_part_bytes;
            REQUIRE(shared_bytes() == expected * static_cast<std::uint64_t>(ranks));
        }
    });
}
