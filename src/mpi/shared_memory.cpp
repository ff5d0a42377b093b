// SPDX-License-Identifier: MIT
// POSIX shared memory. Not MPI_Win_allocate_shared: under Open MPI, ranks wait forever if there is
// no room for a window (docs/adr/051).
#include "mpi/shared_memory.hpp"

#if defined(__linux__)
#define CELLIST_SHARES_MEMORY
#include <cerrno>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>
#endif

#include <array>
#include <atomic>
#include <chrono>
#include <cstdio>

namespace cellist::detail {

namespace {

/// The name of a part; empty if there is none.
using PartName = std::array<char, 48>;

#ifdef CELLIST_SHARES_MEMORY

std::uint64_t whole_pages(std::uint64_t bytes) {
    const auto page = static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
    return (bytes + page - 1) / page * page;
}

/// Maps the part with a name, or makes it and maps it. Returns null if that fails.
std::byte* map_part(const PartName& name, std::uint64_t bytes, bool makes_it) {
    const int flags = makes_it ? O_RDWR | O_CREAT | O_EXCL : O_RDWR;
    const int file = shm_open(name.data(), flags, S_IRUSR | S_IWUSR);
    if (file < 0) return nullptr;
    // Where room is found missing only at an access, that access ends the program.
    int error = makes_it ? EINTR : 0;
    while (error == EINTR) error = posix_fallocate(file, 0, static_cast<off_t>(bytes));
    void* mapped = MAP_FAILED;
    if (error == 0) mapped = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
    close(file);
    if (mapped != MAP_FAILED) return static_cast<std::byte*>(mapped);
    if (makes_it) shm_unlink(name.data());
    return nullptr;
}

/// A name that no other process has, also if it has the same number in another container.
PartName new_name() {
    PartName name{};
    const auto now = std::chrono::system_clock::now().time_since_epoch().count();
    std::snprintf(name.data(), name.size(), "/cellist-%x-%llx", static_cast<unsigned>(getpid()),
                  static_cast<unsigned long long>(now));
    return name;
}

#endif

}  // namespace

bool SharedMemory::allocate(std::uint64_t bytes) {
    release();
#ifdef CELLIST_SHARES_MEMORY
    const std::size_t ranks = communicator_.host_ranks().size();
    const auto self = static_cast<std::size_t>(communicator_.host_rank());
    parts_.resize(ranks, nullptr);
    part_bytes_ = whole_pages(bytes);
    std::vector<PartName> names(ranks);
    PartName name = new_name();
    parts_[self] = map_part(name, part_bytes_, true);
    const bool has_name = parts_[self] != nullptr;
    if (!has_name) name = {};
    MPI_Allgather(name.data(), static_cast<int>(name.size()), MPI_CHAR, names.data(),
                  static_cast<int>(name.size()), MPI_CHAR, communicator_.host());
    int has_all = 1;
    for (std::size_t rank = 0; rank < ranks; ++rank) {
        if (rank != self && names[rank][0] != '\0')
            parts_[rank] = map_part(names[rank], part_bytes_, false);
        if (parts_[rank] == nullptr) has_all = 0;
    }
    MPI_Allreduce(MPI_IN_PLACE, &has_all, 1, MPI_INT, MPI_MIN, communicator_.host());
    // The memory lives as long as it is mapped.
    if (has_name) shm_unlink(name.data());
    if (has_all == 1) return true;
    release();
#else
    static_cast<void>(bytes);
#endif
    return false;
}

void SharedMemory::release() noexcept {
#ifdef CELLIST_SHARES_MEMORY
    for (std::byte* part : parts_)
        if (part != nullptr) munmap(part, part_bytes_);
#endif
    parts_.clear();
    part_bytes_ = 0;
}

void SharedMemory::synchronise() const {
    std::atomic_thread_fence(std::memory_order_seq_cst);
    MPI_Barrier(communicator_.host());
    std::atomic_thread_fence(std::memory_order_seq_cst);
}

}  // namespace cellist::detail
