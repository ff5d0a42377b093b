// SPDX-License-Identifier: MIT
// The main of tests that run on several ranks: all ranks run the same tests in the same order.
#define CELLIST_TESTS_MAIN
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

int main(int argument_count, char** arguments) {
    int level = 0;
    MPI_Init_thread(&argument_count, &arguments, MPI_THREAD_FUNNELED, &level);
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
