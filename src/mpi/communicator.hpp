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

/// A duplicate of the program's communicator. All functions but get(), rank(), size() and begin()
/// are collective.
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
    mutable std::string call_;
};

}  // namespace cellist::detail
