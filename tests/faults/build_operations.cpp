// SPDX-License-Identifier: MIT
// Builds, of every kind.
#include <optional>

#include "checks.hpp"
#include "layer.hpp"
#include "operations.hpp"

namespace cellist::test {
namespace {

void build(Scene& scene) { scene.build(); }

void build_automatic(Scene& scene) {
    scene.build();
    scene.forgive_missing_memory();
}

Pending<BuildReport> start_build(Scene& scene) {
    scene.lists_hold = Contents::empty;
    return scene.lists.build_async(scene.insert, insert_range(), scene.cells, scene.records,
                                   insert_count);
}

void build_later(Scene& scene) {
    Pending<BuildReport> pending = start_build(scene);
    scene.lists_hold = Contents::full;  // what reads them finishes the build
    (void)pending.ready();
    scene.lists_hold = Contents::empty;
    const BuildReport report = pending.get();
    scene.lists_hold = Contents::full;
    require_all_stored(report, scene.oracle);
}

/// A build, and something that reads its lists before its report. Where that fails, the report
/// tells what was done before.
auto build_later_and(Scene& scene, const auto& read) {
    Pending<BuildReport> pending = start_build(scene);
    auto found = [&] {
        try {
            return read();
        } catch (const OpenClError&) {
            const faults::Pause pause;
            try {
                require_all_stored(pending.get(), scene.oracle);
                scene.lists_hold = Contents::full;
            } catch (const OpenClError&) {}
            throw;
        }
    }();
    // Under drop, the build itself may fail even now; its lists are empty then.
    require_all_stored(pending.get(), scene.oracle);
    scene.lists_hold = Contents::full;
    return found;
}

void build_later_and_read(Scene& scene) {
    require_same(build_later_and(scene, [&] { return scene.lists.download(); }), scene.oracle);
}

void build_later_and_validate(Scene& scene) {
    require_sound(build_later_and(scene, [&] { return scene.lists.validate(); }));
}

/// Under drop the copy has room for the whole pool, whose rest holds anything.
void build_later_and_pack(Scene& scene) {
    const Packed<Item> packed = build_later_and(scene, [&] { return scene.lists.pack(); });
    const faults::Pause pause;
    const std::vector<cl_uint> offsets = packed.offsets.download();
    std::vector<Item> records = packed.records.download();
    REQUIRE(records.size() == scene.lists.capacity_nodes());
    REQUIRE(offsets.back() == scene.oracle.size());
    records.resize(offsets.back());
    require_same(HostLists<Item>({cell_count}, {offsets.begin(), offsets.end()}, records),
                 scene.oracle);
}

void abandon_a_build(Scene& scene) {
    Lists<Item> lists(scene.device, {cell_count}, scene.options);
    const Pending<BuildReport> pending =
        lists.build_async(scene.insert, insert_range(), scene.cells, scene.records, insert_count);
    scene.silent = faults::failures().empty();
}

void build_both(Scene& scene) {
    scene.uses_other = true;
    scene.lists_hold = scene.other_holds = Contents::empty;
    const auto [report, other] = cellist::build(
        [&] {
            scene.insert_both.run(insert_range(), scene.lists, scene.other, scene.cells,
                                  scene.records, insert_count);
        },
        scene.lists, scene.other);
    scene.lists_hold = scene.other_holds = Contents::full;
    require_all_stored(report, scene.oracle);
    require_all_stored(other, scene.oracle);
}

void build_both_later(Scene& scene) {
    scene.uses_other = true;
    scene.lists_hold = scene.other_holds = Contents::empty;
    auto pending = cellist::build_async(
        [&] {
            scene.insert_both.run(insert_range(), scene.lists, scene.other, scene.cells,
                                  scene.records, insert_count);
        },
        scene.lists, scene.other);
    const auto [report, other] = pending.get();
    scene.lists_hold = scene.other_holds = Contents::full;
    require_all_stored(report, scene.oracle);
    require_all_stored(other, scene.oracle);
}

/// A kernel of the build reads a container that is no part of it.
void build_beside_another(Scene& scene) {
    const Buffer<cl_uint2> sums(scene.device, cell_count);
    scene.lists_hold = Contents::empty;
    const BuildReport report = scene.lists.build([&] {
        scene.insert.run(insert_range(), scene.lists, scene.cells, scene.records, insert_count);
        scene.read.run(Range::padded(cell_count, 32), scene.other, sums);
    });
    scene.lists_hold = Contents::full;
    require_all_stored(report, scene.oracle);
}

/// A kernel on another queue of the context. It stays for all tests.
Kernel& insert_on_another_queue(const Scene& scene) {
    const faults::Pause pause;
    static Kernel* const kernel = [&] {
        const cl::Device device = scene.device.context().getInfo<CL_CONTEXT_DEVICES>().front();
        const Device user(scene.device.context(), cl::CommandQueue(scene.device.context(), device));
        return new Kernel(user, scene_source(), "insert", type<Item>);
    }();
    return * kernel;
}

void build_by_another_queue(Scene& scene) {
    Kernel& insert = insert_on_another_queue(scene);
    scene.lists_hold = Contents::empty;
    const BuildReport report =
        scene.lists.build(insert, insert_range(), scene.cells, scene.records, insert_count);
    scene.lists_hold = Contents::full;
    require_all_stored(report, scene.oracle);
}

void build_and_stop(Scene& scene) {
    std::optional<OverflowError> error;
    try {
        scene.build();
    } catch (const OverflowError& caught) {
        error = caught;
    }
    REQUIRE(error.has_value());
    scene.silent = true;
    const BuildReport& report = error->report();
    REQUIRE(report.stored + report.dropped == scene.oracle.size());
    REQUIRE(report.rejected == insert_count - scene.oracle.size());
    // The room is that of the options, whatever went wrong in earlier builds.
    REQUIRE(report.capacity_nodes == (scene.options.storage == Storage::fixed
                                          ? *scene.options.slots * std::uint64_t{cell_count}
                                          : *scene.options.capacity_nodes));
}

/// Runs `change`, which keeps the records if it fails. If bringing them back fails as well, the
/// lists are empty.
void change_full_lists(Scene& scene, const auto& change) {
    {
        const faults::Pause pause;
        scene.build();
        // Compiles what brings the records back.
        (void)scene.lists.copy();
    }
    try {
        change();
    } catch (const OpenClError&) {
        const faults::Pause pause;
        if (faults::failures().size() > 1 && scene.lists.lengths().total == 0)
            scene.lists_hold = Contents::empty;
        throw;
    }
    const faults::Pause pause;
    scene.build();
}

void require_twice(const Scene& scene, const BuildReport& report) {
    const faults::Pause pause;
    REQUIRE(report.existing == scene.oracle.size());
    REQUIRE(report.attempted == insert_count);
    REQUIRE(report.stored == 2 * scene.oracle.size());
    require_sound(scene.lists.validate());
    Oracle<Item> oracle = scene.oracle;
    oracle.insert(scene.oracle.begin(), scene.oracle.end());
    require_same(scene.lists.download(), oracle);
}

void append(Scene& scene) {
    change_full_lists(scene, [&] {
        require_twice(scene, scene.lists.append(scene.insert, insert_range(), scene.cells,
                                                scene.records, insert_count));
    });
}

void append_later(Scene& scene) {
    change_full_lists(scene, [&] {
        Pending<BuildReport> pending = scene.lists.append_async(
            scene.insert, insert_range(), scene.cells, scene.records, insert_count);
        require_twice(scene, pending.get());
    });
}

void merge(Scene& scene) {
    change_full_lists(scene, [&] {
        require_twice(scene, [&] {
            const Lists<Item> copy = scene.lists.copy();
            BuildReport report = scene.lists.merge(copy);
            report.attempted += insert_count - scene.oracle.size();
            return report;
        }());
    });
}

void remove(Scene& scene) {
    change_full_lists(scene, [&] {
        const std::uint64_t removed = scene.lists.remove_if("record.id & 1");
        const faults::Pause pause;
        Oracle<Item> left = scene.oracle;
        REQUIRE(removed ==
                std::erase_if(left, [](const auto& entry) { return (entry.second.id & 1) != 0; }));
        require_sound(scene.lists.validate());
        require_same(scene.lists.download(), left);
    });
}

void build_slices(Scene& scene) {
    scene.lists_hold = Contents::empty;
    Oracle<Item> found;
    std::uint64_t slices = 0;
    const BuildReport report = scene.lists.build_slices(
        [&] {
            scene.insert.run(insert_range(), scene.lists, scene.cells, scene.records, insert_count);
        },
        [&](const Slice& slice) {
            const HostLists<Item> lists = scene.lists.download();
            for (std::uint64_t i = 0; i < slice.cells; ++i)
                for (const Item& item : lists.cell(slice.first_cell + i))
                    found.emplace(slice.first_cell + i, item);
            ++slices;
        });
    REQUIRE(report.stored == scene.oracle.size());
    REQUIRE(slices > 1);
    REQUIRE(found.size() == scene.oracle.size());
    for (std::uint64_t cell = 0; cell < cell_count; ++cell) {
        REQUIRE(in_order(found, cell, by_id) == in_order(scene.oracle, cell, by_id));
    }
}

}  // namespace

std::span<const Operation> build_operations() {
    using enum Contents;
    using enum Use;
    static constexpr Operation table[] = {
        {"build", empty, build},
        {"build over full lists", full, build, repeated},
        {"build that grows", empty, build, first, Room::none},
        {"build that may drop", empty, build, repeated, Room::enough, Overflow::drop},
        {"build that may stop", empty, build, repeated, Room::enough, Overflow::stop},
        {"build that stops", empty, build_and_stop, repeated, Room::too_little, Overflow::stop},
        {"build that keeps the nearest", empty, build, repeated, Room::enough, Overflow::grow,
         Kind::nearest},
        {"build later", full, build_later, repeated},
        {"build later and grow", empty, build_later, first, Room::too_little},
        {"build later and read", empty, build_later_and_read, repeated},
        {"build later, drop and read", empty, build_later_and_read, repeated, Room::enough,
         Overflow::drop},
        {"build later, drop and validate", empty, build_later_and_validate, repeated, Room::enough,
         Overflow::drop},
        {"build later, drop and pack", empty, build_later_and_pack, repeated, Room::enough,
         Overflow::drop},
        {"abandon a build", full, abandon_a_build, repeated},
        {"build in an automatic storage", empty, build_automatic, first, Room::enough,
         Overflow::grow, Kind::automatic},
        {"build two containers", empty, build_both, repeated},
        {"build two containers that grow", empty, build_both, first, Room::too_little},
        {"build two containers later", empty, build_both_later, repeated},
        {"build beside another container", empty, build_beside_another, repeated, Room::enough,
         Overflow::grow},
        {"build by a kernel on another queue", empty, build_by_another_queue, repeated,
         Room::enough, Overflow::grow},
        {"append", full, append},
        {"append with room", full, append, repeated},
        {"append to lists that grow", full, append, first, Room::too_little},
        {"append that may drop", full, append, repeated, Room::enough, Overflow::drop},
        {"append that may stop", full, append, repeated, Room::enough, Overflow::stop},
        {"append later", full, append_later, repeated},
        {"merge a copy", full, merge, repeated},
        {"remove records", full, remove, repeated},
        {"build slices", empty, build_slices, repeated, Room::for_a_part, Overflow::grow},
    };
    return table;
}

}  // namespace cellist::test
