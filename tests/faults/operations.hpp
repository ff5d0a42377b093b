#pragma once
// What the library is asked to do while OpenCL calls fail.

#include <span>

#include "support/inserts.hpp"

namespace cellist::test {

/// What lists hold: nothing, or what the scene inserts.
enum class Contents { empty, full };

/// Whether the operation is the first of its kind in its container, so that it compiles and makes the
/// kernels that it needs.
enum class Use { first, repeated };

/// How much room a container has at first, or for a part of the records: always.
enum class Room { none, too_little, enough, for_a_part };

struct Scene;

/// An operation on the containers of a scene. One more is one more line in operations.cpp.
struct Operation {
    const char* name;
    /// What scene.lists holds before.
    Contents before;
    /// Calls the library and checks all that it returns; does the same work each time. No call of the
    /// library stands in a REQUIRE, which would catch what it throws.
    void (*run)(Scene& scene);
    Use use = Use::first;
    Room room = Room::enough;
    Overflow overflow = Overflow::grow;
    std::uint64_t step = 1;  ///< more where it takes long: each so many-th call fails
    /// In Storage::automatic, whose next build tries the storage.
    bool automatic = false;
    /// Where there is no memory it goes another way, on which a later call may fail.
    bool falls_back = false;
};
std::span<const Operation> operations();

/// Work that makes all objects that it needs and leaves none. As Operation otherwise.
struct Life {
    const char* name;
    void (*run)(const Device& device, Storage storage);
    std::uint64_t step = 1;
};
std::span<const Life> lives();

/// A container with kernels that fill and read it, and what it must hold then.
struct Scene {
    Scene(const Device& device, Storage storage, const Operation& operation);

    /// Fills the lists with Lists::build, and checks the report.
    void build();
    /// Requires that the containers are sound and hold what they must. No call fails in here.
    void require_contents() const;

    const Device& device;
    ListsOptions options;
    Inserts<Item> inserts;
    Oracle<Item> oracle;  ///< the inserts by cell
    Buffer<cl_uint> cells;
    Buffer<Item> records;
    Lists<Item> lists;
    Lists<Item> other;  ///< of another storage; empty before each operation
    Kernel insert;      ///< into one container
    Kernel insert_both;
    Kernel read;

    /// What the containers hold if the next call fails.
    Contents lists_hold = Contents::empty;
    Contents other_holds = Contents::empty;
    bool uses_other = false;  ///< `other` has been touched
    /// Whether a failure may end in no error: while a build throws OverflowError, which comes first; in
    /// the end of a build that nobody waited for; where an automatic storage finds no memory, and
    /// another does.
    bool silent = false;
};

}  // namespace cellist::test
