// SPDX-License-Identifier: MIT
#include "mpi/communicator.hpp"

#include <algorithm>
#include <array>
#include <new>

#include <cellist/error.hpp>

namespace cellist::detail {

namespace {

/// The most bytes of one call: counts of MPI are of type int.
constexpr std::uint64_t bytes_max = std::uint64_t{1} << 30;

/// An exception as one rank sends it to all.
struct Failure {
    enum class Kind : std::uint64_t { other, memory, overflow, open_cl };
    Kind kind = Kind::other;
    std::int64_t code = 0;
    std::uint64_t text_bytes = 0;
    std::uint64_t log_bytes = 0;
    BuildReport report;
};

struct FailureText {
    std::string text;  ///< the message; of an OpenClError, the call
    std::string log;
};

/// Describes an exception. Types that the library does not have become `other`.
void describe(const std::exception_ptr& error, Failure& failure, FailureText& text) {
    try {
        std::rethrow_exception(error);
    } catch (const OpenClError& failed) {
        failure.kind = Failure::Kind::open_cl;
        failure.code = failed.code();
        text = {failed.call(), failed.log()};
    } catch (const OverflowError& overflow) {
        failure.kind = Failure::Kind::overflow;
        failure.report = overflow.report();
        text.text = overflow.what();
    } catch (const MemoryError& memory) {
        failure.kind = Failure::Kind::memory;
        text.text = memory.what();
    } catch (const std::bad_alloc&) {
        failure.kind = Failure::Kind::memory;
        text.text = "the host has no memory left";
    } catch (const std::exception& other) {
        text.text = other.what();
    } catch (...) {
        text.text = "an exception of an unknown type";
    }
    failure.text_bytes = text.text.size();
    failure.log_bytes = text.log.size();
}

[[noreturn]] void raise(const Failure& failure, const FailureText& text) {
    switch (failure.kind) {
        case Failure::Kind::open_cl:
            throw OpenClError(text.text, static_cast<cl_int>(failure.code), text.log);
        case Failure::Kind::overflow:
            throw OverflowError(text.text, failure.report);
        case Failure::Kind::memory:
            throw MemoryError(text.text);
        case Failure::Kind::other:
            break;
    }
    throw Error(text.text);
}

/// FNV-1a, which is the same on all hosts.
std::uint64_t hash_of(const std::string& text) {
    std::uint64_t hash = 0xcbf2'9ce4'8422'2325;
    for (const char character : text)
        hash = (hash ^ static_cast<unsigned char>(character)) * 0x100'0000'01b3;
    return hash;
}

void require_ready(MPI_Comm comm) {
    int initialised = 0, finalised = 0, level = 0, is_main = 0;
    MPI_Initialized(&initialised);
    if (initialised == 0)
        throw Error("MPI is not initialised: call MPI_Init_thread with MPI_THREAD_FUNNELED first");
    MPI_Finalized(&finalised);
    if (finalised != 0) throw Error("MPI is used after MPI_Finalize");
    MPI_Query_thread(&level);
    if (level < MPI_THREAD_FUNNELED)
        throw Error(
            "MPI has the thread level MPI_THREAD_SINGLE, but OpenCL drivers use threads: "
            "initialise it with MPI_Init_thread and MPI_THREAD_FUNNELED");
    MPI_Is_thread_main(&is_main);
    if (level == MPI_THREAD_FUNNELED && is_main == 0)
        throw Error(
            "MPI has the thread level MPI_THREAD_FUNNELED, which lets only the thread that "
            "initialised it call: ask MPI_Init_thread for MPI_THREAD_SERIALIZED");
    if (comm == MPI_COMM_NULL) throw Error("MPI_COMM_NULL is no communicator");
    int is_inter = 0;
    MPI_Comm_test_inter(comm, &is_inter);
    if (is_inter != 0) throw Error("an intercommunicator cannot have a partition: merge it first");
}

}  // namespace

Communicator::Communicator(MPI_Comm comm) {
    require_ready(comm);
    MPI_Comm_dup(comm, &comm_);
    // A rank that dies, or a message that fails, ends the job, so no rank waits forever.
    MPI_Comm_set_errhandler(comm_, MPI_ERRORS_ARE_FATAL);
    MPI_Comm_rank(comm_, &rank_);
    MPI_Comm_size(comm_, &size_);
    MPI_Comm_split_type(comm_, MPI_COMM_TYPE_SHARED, rank_, MPI_INFO_NULL, &host_);
    MPI_Comm_set_errhandler(host_, MPI_ERRORS_ARE_FATAL);
    MPI_Comm_rank(host_, &host_rank_);
    int host_size = 0;
    MPI_Comm_size(host_, &host_size);
    std::vector<int> ranks(static_cast<std::size_t>(host_size));
    MPI_Allgather(&rank_, 1, MPI_INT, ranks.data(), 1, MPI_INT, host_);
    host_ranks_.assign(ranks.begin(), ranks.end());
}

Communicator::~Communicator() {
    int finalised = 0;
    MPI_Finalized(&finalised);
    if (finalised != 0) return;
    MPI_Comm_free(&host_);
    MPI_Comm_free(&comm_);
}

int Communicator::turn_on_host(const std::string& text) const {
    const std::uint64_t hash = hash_of(text);
    std::vector<std::uint64_t> hashes(host_ranks_.size());
    MPI_Allgather(&hash, 1, MPI_UINT64_T, hashes.data(), 1, MPI_UINT64_T, host_);
    return static_cast<int>(std::count(hashes.begin(), hashes.begin() + host_rank_, hash));
}

void Communicator::agree(const std::exception_ptr& error) const {
    if (size_ == 1) {
        if (error) std::rethrow_exception(error);
        return;
    }
    // The lowest rank that fails, the least hash of a call, and the complement of the greatest.
    const std::uint64_t hash = hash_of(call_);
    std::array<std::uint64_t, 3> least{static_cast<std::uint64_t>(error ? rank_ : size_), hash,
                                       ~hash};
    reduce(least.data(), least.size(), MPI_MIN);
    const int failed = static_cast<int>(least[0]);
    if (failed == size_ && least[1] == ~least[2]) return;
    if (failed == size_) require_same(call_, "collective calls");
    Failure failure;
    FailureText text;
    if (failed == rank_) describe(error, failure, text);
    broadcast(&failure, sizeof failure, failed);
    text.text.resize(failure.text_bytes);
    text.log.resize(failure.log_bytes);
    broadcast(text.text.data(), text.text.size(), failed);
    broadcast(text.log.data(), text.log.size(), failed);
    const std::string name = "rank " + std::to_string(failed) + ": ";
    // A collective call within another one has named the rank.
    if (!text.text.starts_with(name)) text.text.insert(0, name);
    raise(failure, text);
}

void Communicator::together(const std::function<void()>& call) const {
    std::exception_ptr error;
    try {
        call();
    } catch (...) {
        error = std::current_exception();
    }
    agree(error);
}

void Communicator::require_same(const std::string& text, const std::string& what) const {
    std::uint64_t bytes = text.size();
    broadcast(&bytes, sizeof bytes, 0);
    std::string first = text;
    first.resize(bytes);
    broadcast(first.data(), bytes, 0);
    int differs = first == text ? size_ : rank_;
    MPI_Allreduce(MPI_IN_PLACE, &differs, 1, MPI_INT, MPI_MIN, comm_);
    if (differs == size_) return;
    bytes = text.size();
    broadcast(&bytes, sizeof bytes, differs);
    std::string other = text;
    other.resize(bytes);
    broadcast(other.data(), bytes, differs);
    throw Error("the ranks name different " + what + ": rank 0 has " + first + ", rank " +
                std::to_string(differs) + " has " + other);
}

std::vector<std::uint64_t> Communicator::transpose(
    const std::vector<std::uint64_t>& numbers) const {
    std::vector<std::uint64_t> received(numbers.size());
    MPI_Alltoall(numbers.data(), 1, MPI_UINT64_T, received.data(), 1, MPI_UINT64_T, comm_);
    return received;
}

void Communicator::reduce(std::uint64_t* numbers, std::uint64_t count, MPI_Op operation) const {
    constexpr std::uint64_t most = bytes_max / sizeof *numbers;
    for (std::uint64_t at = 0; at < count; at += most)
        MPI_Allreduce(MPI_IN_PLACE, numbers + at, static_cast<int>(std::min(most, count - at)),
                      MPI_UINT64_T, operation, comm_);
}

void Communicator::broadcast(void* data, std::uint64_t bytes, int root) const {
    for (std::uint64_t at = 0; at < bytes; at += bytes_max)
        MPI_Bcast(static_cast<std::byte*>(data) + at,
                  static_cast<int>(std::min(bytes_max, bytes - at)), MPI_BYTE, root, comm_);
}

}  // namespace cellist::detail
