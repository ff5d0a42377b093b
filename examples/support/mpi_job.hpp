// SPDX-License-Identifier: MIT
#pragma once

#include <concepts>
#include <exception>
#include <string>

#include <mpi.h>

#include "files.hpp"

namespace support {

/// MPI from its construction to its destruction, once in a program. The thread that constructs it
/// makes all calls of MPI.
class MpiJob {
public:
    /// Initialises MPI. `program` begins the lines of errors.
    explicit MpiJob(std::string program);
    ~MpiJob();
    MpiJob(const MpiJob&) = delete;
    MpiJob& operator=(const MpiJob&) = delete;

    [[nodiscard]] int rank() const { return rank_; }
    [[nodiscard]] int ranks() const { return ranks_; }
    [[nodiscard]] bool is_first() const { return rank_ == 0; }

    /// Calls `work` on all ranks; returns true if it returned true on all of them.
    ///
    /// An exception that all ranks throw is printed once, and the result is false. If only some
    /// ranks throw, the others may wait for them forever: these ranks print their exceptions, with
    /// their numbers, and end the job.
    [[nodiscard]] bool run(std::predicate auto&& work);

private:
    enum class End { good, bad, failed };
    // Waits for all ranks. A rank that failed waits for a limited time.
    [[nodiscard]] bool finish(End end, const std::string& error) const;

    std::string program_;
    MPI_Comm ends_ = MPI_COMM_NULL;  ///< for messages that say how the work of each rank ended
    int rank_ = 0;
    int ranks_ = 1;
};

/// Returns the devices of all ranks as text, such as "2 x NVIDIA H200". `name` is this rank's.
/// Collective over MPI_COMM_WORLD.
[[nodiscard]] std::string devices_of_all_ranks(const std::string& name);

}  // namespace support

// ---- implementation

bool support::MpiJob::run(std::predicate auto&& work) {
    try {
        return finish(work() ? End::good : End::bad, "");
    } catch (const OutputClosed&) {
        return finish(End::bad, "");
    } catch (const std::exception& error) {
        return finish(End::failed, error.what());
    }
}
