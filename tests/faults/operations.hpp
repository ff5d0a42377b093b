// SPDX-License-Identifier: MIT
#pragma once
// What the library is asked to do while OpenCL calls fail.

#include <span>
#include <vector>

#include "support/inserts.hpp"

namespace cellist::test {

/// What lists hold: nothing, or what the scene inserts.
enum class Contents { empty, full };

/// Whether the operation is the first of its kind in its container, so that it compiles and makes
/// the kernels that it needs.
enum class Use { first, repeated };

/// How much room a container has at first, or for a part of the records: always.
enum class Room { none, too_little, enough, for_a_part };

/// The kind of a container: of the storage that is tested, of nearest(), or of Storage::automatic,
/// whose next build tries the storage.
enum class Kind { plain, nearest, automatic };

struct Scene;

/// An operation on the containers of a scene. A new one is a new line in a table.
struct Operation {
    const char* name;
    /// What scene.lists holds before.
    Contents before;
    /// Calls the library and checks all that it returns; does the same work each time. No call of
    /// the library stands in a REQUIRE, which would catch what it throws.
    void (*run)(Scene& scene);
    Use use = Use::first;
    Room room = Room::enough;
    Overflow overflow = Overflow::grow;
    Kind kind = Kind::plain;
    /// Where there is no memory it goes another way, on which a later call may fail. That failure
    /// is then what it throws.
    bool falls_back = false;
};
std::vector<Operation> operations();

/// The tables that operations() consists of.
std::span<const Operation> object_operations();
std::span<const Operation> build_operations();
std::span<const Operation> sort_operations();
std::span<const Operation> read_operations();

/// Work that makes all objects that it needs and leaves none. As Operation otherwise.
struct Life {
    const char* name;
    void (*run)(const Device& device, Storage storage);
    std::uint64_t step = 1;
    /// As in Operation; what it does then may succeed.
    bool falls_back = false;
};
std::span<const Life> lives();

}  // namespace cellist::test
