// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

#include "operations.hpp"

namespace cellist::test {

constexpr cl_uint cell_count = 17;
constexpr cl_uint insert_count = 93;

/// The kernels `insert`, `insert_both` and `read`.
std::string_view scene_source();
/// A work-item for each insert.
Range insert_range();
/// The first items are outside of the shape.
Inserts<Item> scene_inserts();
ListsOptions scene_options(const Device& device, Storage storage, Room room, Overflow overflow,
                           Kind kind = Kind::plain);

/// A container with kernels that fill and read it, and what it must hold then.
struct Scene {
    Scene(const Device& device, Storage storage, const Operation& operation);

    /// Fills the lists with Lists::build, and checks the report.
    void build();
    /// What is missing may be missing in silence, if all failures so far tell of missing memory:
    /// the operation can do without.
    void forgive_missing_memory();
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
    /// Whether a failure may end in no error: while a build throws OverflowError, which comes
    /// first; in the end of a build that nobody waited for; where an automatic storage finds no
    /// memory, and another does.
    bool silent = false;
};

}  // namespace cellist::test
