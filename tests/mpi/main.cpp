// SPDX-License-Identifier: MIT
// The main of tests that run on several ranks: all ranks run the same tests in the same order.
#define CELLIST_TESTS_MAIN
#include <csignal>
#include <cstdlib>
#include <iostream>
#include <optional>
#include <sstream>

#include "mpi/ranks.hpp"
#include "support/catch.hpp"
#include "support/device.hpp"

namespace {

std::optional<cellist::Device> shared_device;

}  // namespace

const cellist::Device& cellist::test::device() {
    if (!shared_device) shared_device = Device::choose();
    return *shared_device;
}

int cellist::test::world_rank() {
    int rank = 0;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    return rank;
}

int cellist::test::world_size() {
    int size = 0;
    MPI_Comm_size(MPI_COMM_WORLD, &size);
    return size;
}

void cellist::test::with_ranks(int ranks, const std::function<void(MPI_Comm)>& call) {
    MPI_Comm some = MPI_COMM_NULL;
    MPI_Comm_split(MPI_COMM_WORLD, world_rank() < ranks ? 0 : MPI_UNDEFINED, world_rank(), &some);
    if (some == MPI_COMM_NULL) return;
    call(some);
    MPI_Comm_free(&some);
}

void cellist::test::with_all_counts(const std::function<void(MPI_Comm, int ranks)>& call) {
    for (int ranks = 1; ranks <= world_size(); ++ranks)
        with_ranks(ranks, [&](MPI_Comm comm) { call(comm, ranks); });
}

std::string cellist::test::common_error(MPI_Comm comm, const std::function<void()>& call) {
    std::string message;
    try {
        call();
    } catch (const std::exception& error) {
        message = error.what();
    }
    std::string first = message;
    unsigned size = static_cast<unsigned>(first.size());
    MPI_Bcast(&size, 1, MPI_UNSIGNED, 0, comm);
    first.resize(size);
    MPI_Bcast(first.data(), static_cast<int>(size), MPI_CHAR, 0, comm);
    int same = first == message ? 1 : 0;
    MPI_Allreduce(MPI_IN_PLACE, &same, 1, MPI_INT, MPI_MIN, comm);
    INFO("rank 0: '" << first << "', this rank: '" << message << "'");
    REQUIRE(same == 1);
    return message;
}

namespace {

/// What must throw while MPI is not ready.
bool refuses_partition(const std::string& part) {
    try {
        const cellist::mpi::Partition partition(MPI_COMM_WORLD, cellist::Shape{4});
    } catch (const cellist::Error& error) {
        if (std::string(error.what()).find(part) != std::string::npos) return true;
        std::cerr << "another error than '" << part << "': " << error.what() << std::endl;
        return false;
    }
    std::cerr << "no error: " << part << std::endl;
    return false;
}

/// Tests states of MPI that no program of the other tests has.
int run_single_threaded(int argument_count, char** arguments) {
    bool refuses = refuses_partition("MPI is not initialised");
    MPI_Init(&argument_count, &arguments);
    int level = 0;
    MPI_Query_thread(&level);
    if (level == MPI_THREAD_SINGLE) refuses = refuses_partition("MPI_THREAD_SINGLE") && refuses;
    MPI_Finalize();
    return refuses && refuses_partition("after MPI_Finalize") ? 0 : 1;
}

/// One rank is killed while the others wait for it. Never returns.
int run_with_killed_rank(int argument_count, char** arguments) {
    int level = 0;
    MPI_Init_thread(&argument_count, &arguments, MPI_THREAD_FUNNELED, &level);
    cellist::mpi::Lists<cellist::test::Item> lists(
        cellist::test::device(), cellist::mpi::Partition(MPI_COMM_WORLD, cellist::Shape{16}));
    lists.build([] {});
    if (cellist::test::world_rank() == 0) std::cout << "all ranks work" << std::endl;
    for (;;)
        lists.build([] {
            if (cellist::test::world_rank() == 1) std::raise(SIGKILL);
        });
}

}  // namespace

int main(int argument_count, char** arguments) {
    if (argument_count == 2 && std::string(arguments[1]) == "single-threaded")
        return run_single_threaded(argument_count, arguments);
    if (argument_count == 2 && std::string(arguments[1]) == "killed")
        return run_with_killed_rank(argument_count, arguments);
    int level = 0;
    MPI_Init_thread(&argument_count, &arguments, MPI_THREAD_FUNNELED, &level);
    // Ranks compile the same programs at the same time. PoCL 3.1 once failed where they shared the
    // folder that keeps them.
    if (const char* const folder = std::getenv("POCL_CACHE_DIR"))
        setenv(
            "POCL_CACHE_DIR",
            (std::string(folder) + "/rank-" + std::to_string(cellist::test::world_rank())).c_str(),
            1);
    // All ranks tell the same, unless one fails.
    const bool is_first = cellist::test::world_rank() == 0;
    std::ostringstream text;
    std::streambuf* const out = std::cout.rdbuf();
    if (!is_first) std::cout.rdbuf(text.rdbuf());
    Catch::Session session;
    // The other ranks would wait for one that has left a test.
    session.configData().abortAfter = 1;
    int failed = session.applyCommandLine(argument_count, arguments);
    if (failed == 0) failed = session.run();
    std::cout.rdbuf(out);
    if (failed != 0) {
        std::cout << text.str() << "rank " << cellist::test::world_rank() << " failed" << std::endl;
        MPI_Abort(MPI_COMM_WORLD, 1);
    }
    shared_device.reset();
    MPI_Finalize();
    return 0;
}
