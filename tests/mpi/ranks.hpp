// SPDX-License-Identifier: MIT
#pragma once

#include <functional>

#include <cellist/mpi.hpp>

#include "support/inserts.hpp"

namespace cellist::test {

[[nodiscard]] int world_rank();
[[nodiscard]] int world_size();

/// Calls a function on the first `ranks` ranks of the program, with their communicator.
void with_ranks(int ranks, const std::function<void(MPI_Comm)>& call);
/// The same for 1, 2, ... ranks, up to all of them.
void with_all_counts(const std::function<void(MPI_Comm, int ranks)>& call);

/// Calls a function that throws the same Error on all ranks, and returns the message. Empty if no
/// rank throws. Fails if only some throw, or if the messages differ.
[[nodiscard]] std::string common_error(MPI_Comm comm, const std::function<void()>& call);

/// The part of the inserts that a rank makes: every `ranks`-th.
template <class T>
[[nodiscard]] Inserts<T> share_of(const Inserts<T>& all, int rank, int ranks) {
    Inserts<T> share;
    for (auto i = static_cast<std::size_t>(rank); i < all.size();
         i += static_cast<std::size_t>(ranks))
        share.add(all.cells[i], all.records[i]);
    return share;
}

/// Makes inserts in distributed lists. Each rank makes its share of them.
template <class T>
class DistributedInserter {
public:
    DistributedInserter(const mpi::Lists<T>& lists, const Inserts<T>& all)
        : inserts_(share_of(all, lists.partition().rank(), lists.partition().ranks())),
          cells_(device(), inserts_.cells),
          records_(device(), inserts_.records),
          kernel_(device(), insert_source(DeviceType<T>::name()), "insert_all", lists) {}

    BuildReport build(mpi::Lists<T>& lists) {
        const auto count = static_cast<cl_uint>(inserts_.size());
        return lists.build(kernel_, Range::padded(count, 64), cells_, records_, count);
    }
    void run(const mpi::Lists<T>& lists) {
        const auto count = static_cast<cl_uint>(inserts_.size());
        kernel_.run(Range::padded(count, 64), lists, cells_, records_, count);
    }

private:
    Inserts<T> inserts_;
    Buffer<cl_uint> cells_;
    Buffer<T> records_;
    Kernel kernel_;
};

}  // namespace cellist::test
