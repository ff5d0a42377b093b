// SPDX-License-Identifier: MIT
// What reads lists.
#include "checks.hpp"
#include "layer.hpp"
#include "operations.hpp"

namespace cellist::test {
namespace {

void lengths(Scene& scene) { require_lengths(scene.lists.lengths(), scene.oracle); }
void lengths_on_device(Scene& scene) {
    const Buffer<cl_uint> lengths = scene.lists.device_lengths();
    const Buffer<cl_uint> offsets = scene.lists.device_offsets();
    const Buffer<cl_uint> histogram = scene.lists.device_histogram(2);
    const std::vector<cl_uint> found = lengths.download();
    for (cl_uint cell = 0; cell < cell_count; ++cell) {
        REQUIRE(found[cell] == scene.oracle.count(cell));
    }
    const faults::Pause pause;
    REQUIRE(offsets.download().back() == scene.oracle.size());
    REQUIRE(histogram.download()[1] == scene.lists.lengths().nonempty_cells);
}
void pack(Scene& scene) { require_packed(scene.lists.pack(), scene.oracle); }
void pack_a_member(Scene& scene) { require_packed_ids(scene.lists.pack(&Item::id), scene.oracle); }
void download(Scene& scene) { require_same(scene.lists.download(), scene.oracle); }
void validate(Scene& scene) { require_sound(scene.lists.validate()); }

/// Three results are on their way at once.
void read_later(Scene& scene) {
    Pending<HostLists<Item>> lists = scene.lists.download_async();
    Pending<Lengths> lengths = scene.lists.lengths_async();
    Pending<Validation> validation = scene.lists.validate_async();
    require_same(lists.get(), scene.oracle);
    require_lengths(lengths.get(), scene.oracle);
    require_sound(validation.get());
}

void read_in_a_kernel(Scene& scene) {
    const Buffer<cl_uint2> sums(scene.device, cell_count);
    scene.read.run(Range::padded(cell_count, 32), scene.lists, sums);
    const std::vector<cl_uint2> found = sums.download();
    for (cl_uint cell = 0; cell < cell_count; ++cell) {
        cl_uint2 expected{{0, 0}};
        const auto [begin, end] = scene.oracle.equal_range(cell);
        for (auto entry = begin; entry != end; ++entry) {
            ++expected.s[0];
            expected.s[1] += entry->second.id;
        }
        REQUIRE(found[cell].s[0] == expected.s[0]);
        REQUIRE(found[cell].s[1] == expected.s[1]);
    }
}

/// All pairs of records whose cells have at most one cell between them.
void neighbours(Scene& scene) {
    const Neighbours found =
        scene.lists.neighbours({.distance = "fabs(record.key - other.key)", .radius_cells = 2});
    std::uint64_t pairs = 0;
    for (const auto& [cell, record] : scene.oracle)
        for (const auto& [near_cell, near] : scene.oracle)
            if (record != near && std::max(cell, near_cell) - std::min(cell, near_cell) <= 2)
                ++pairs;
    const std::vector<cl_uint> offsets = found.offsets.download();
    REQUIRE(found.records == scene.oracle.size());
    REQUIRE(found.pairs == pairs);
    REQUIRE(offsets.back() == pairs);
}

void nearest_of_queries(Scene& scene) {
    const Buffer<cl_int> queries(scene.device, std::vector<cl_int>{0, 16, -9});
    const Nearest<Item> found =
        scene.lists.nearest(queries, {.k = 2, .position = "query", .distance = "record.key"});
    const std::vector<cl_uint> counts = found.counts.download();
    for (std::size_t query = 0; query < 3; ++query) {
        const std::uint64_t first = std::array{0U, 15U, 1U}[query];
        const std::uint64_t cells = query == 2 ? 0 : 2;
        std::size_t expected = 0;
        for (const auto& [cell, record] : scene.oracle)
            if (cell >= first && cell < first + cells) ++expected;
        REQUIRE(counts[query] == std::min<std::size_t>(expected, 2));
    }
}

}  // namespace

std::span<const Operation> read_operations() {
    using enum Contents;
    using enum Use;
    static constexpr Operation table[] = {
        {"lengths", full, lengths},
        {"lengths on the device", full, lengths_on_device},
        {"pack", full, pack, repeated},
        {"pack a member", full, pack_a_member, repeated},
        {"download", full, download},
        {"validate", full, validate},
        {"read later", full, read_later, repeated},
        {"read in a kernel", full, read_in_a_kernel},
        {"neighbours", full, neighbours},
        {"nearest of queries", full, nearest_of_queries, repeated},
    };
    return table;
}

}  // namespace cellist::test
