// SPDX-License-Identifier: MIT
#include "mpi_job.hpp"

#include <algorithm>
#include <chrono>
#include <map>
#include <thread>
#include <utility>
#include <vector>

#include "command_line.hpp"
#include "input_error.hpp"
#include "stopwatch.hpp"

namespace support {
namespace {

// How long a rank that failed waits for the others, which may have failed as well.
constexpr double patience_ms = 2000;

}  // namespace

MpiJob::MpiJob(std::string program) : program_(std::move(program)) {
    int level = MPI_THREAD_SINGLE;
    if (MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &level) != MPI_SUCCESS)
        throw InputError("MPI cannot be initialised");
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &ranks_);
    MPI_Comm_dup(MPI_COMM_WORLD, &ends_);
}

MpiJob::~MpiJob() {
    MPI_Comm_free(&ends_);
    MPI_Finalize();
}

bool MpiJob::finish(End end, const std::string& error) const {
    // Ranks that did not succeed, and those of them that threw.
    const int mine[2] = {end != End::good ? 1 : 0, end == End::failed ? 1 : 0};
    int all[2] = {0, 0};
    MPI_Request request = MPI_REQUEST_NULL;
    MPI_Iallreduce(mine, all, 2, MPI_INT, MPI_SUM, ends_, &request);
    const Stopwatch stopwatch;
    int is_complete = 0;
    MPI_Test(&request, &is_complete, MPI_STATUS_IGNORE);
    while (is_complete == 0 && (end != End::failed || stopwatch.ms() < patience_ms)) {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
        MPI_Test(&request, &is_complete, MPI_STATUS_IGNORE);
    }
    const bool all_failed = is_complete != 0 && all[1] == ranks_;
    if (end == End::failed && (!all_failed || rank_ == 0)) {
        const std::string of_rank =
            "rank " + std::to_string(rank_) + " of " + std::to_string(ranks_) + ": ";
        print_error(program_, (all_failed ? "" : of_rank) + error);
    }
    if (is_complete == 0) MPI_Abort(MPI_COMM_WORLD, 1);
    return all[0] == 0;
}

std::string devices_of_all_ranks(const std::string& name) {
    constexpr std::size_t size = 256;
    int ranks = 1;
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    std::vector<char> mine(size), all(size * static_cast<std::size_t>(ranks));
    std::copy_n(name.begin(), std::min(name.size(), size - 1), mine.begin());
    MPI_Allgather(mine.data(), size, MPI_CHAR, all.data(), size, MPI_CHAR, MPI_COMM_WORLD);
    std::map<std::string, int> counts;
    for (std::size_t first = 0; first < all.size(); first += size) ++counts[&all[first]];
    std::string text;
    for (const auto& [device, count] : counts)
        text += (text.empty() ? "" : ", ") + std::to_string(count) + " x " + device;
    return text;
}

}  // namespace support
