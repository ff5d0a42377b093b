// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <cellist/mpi.hpp>

namespace cellist::detail {

/// A duplicate of the program's communicator. All functions are collective, except begin() and
/// the accessors: get(), rank(), size(), host(), host_rank() and host_ranks().
class Communicator {
public:
    /// Throws Error if MPI is not ready for the library.
    explicit Communicator(MPI_Comm comm);
    ~Communicator();
    Communicator(const Communicator&) = delete;
    Communicator& operator=(const Communicator&) = delete;

    [[nodiscard]] MPI_Comm get() const { return comm_; }
    [[nodiscard]] int rank() const { return rank_; }
    [[nodiscard]] int size() const { return size_; }

    /// The communicator of the ranks on this rank's host, and this rank in it.
    [[nodiscard]] MPI_Comm host() const { return host_; }
    [[nodiscard]] int host_rank() const { return host_rank_; }
    /// What the ranks of host() are in get(), in ascending order.
    [[nodiscard]] const std::vector<std::size_t>& host_ranks() const { return host_ranks_; }

    /// The number of ranks on this host that pass the same text and are before this rank.
    [[nodiscard]] int turn_on_host(const std::string& text) const;

    /// Names the collective call that begins, with its arguments. Local.
    void begin(std::string call) const { call_ = std::move(call); }
    /// If ranks pass exceptions, throws that of the lowest such rank on all ranks. With several
    /// ranks, exceptions of types that the library does not have become Error. Otherwise throws
    /// Error on all ranks if they are in different calls.
    void agree(const std::exception_ptr& error) const;
    /// Calls a function on all ranks, then agrees on what it throws.
    void together(const std::function<void()>& call) const;
    /// Throws Error on all ranks unless all of them pass the same text. `what` is the plural noun
    /// for what the text describes, for the message.
    void require_same(const std::string& text, const std::string& what) const;

    /// Sends element r of `numbers` to each rank r. Element r of the result is from rank r.
    [[nodiscard]] std::vector<std::uint64_t> transpose(
        const std::vector<std::uint64_t>& numbers) const;
    /// Replaces each number by its sum, minimum or maximum over all ranks.
    void reduce(std::uint64_t* numbers, std::uint64_t count, MPI_Op operation) const;
    /// Copies bytes from rank `root` to all ranks.
    void broadcast(void* data, std::uint64_t bytes, int root) const;

private:
    MPI_Comm comm_ = MPI_COMM_NULL;
    int rank_ = 0;
    int size_ = 1;
    MPI_Comm host_ = MPI_COMM_NULL;
    int host_rank_ = 0;
    std::vector<std::size_t> host_ranks_;
    mutable std::string call_;
};

}  // namespace cellist::detail
