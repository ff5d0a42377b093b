// SPDX-License-Identifier: MIT
#include <algorithm>
#include <limits>
#include <optional>

#include <cellist/detail/lists_core.hpp>
#include <cellist/error.hpp>
#include <cellist/neighbours.hpp>

#include "around/contiguous.hpp"
#include "cellist_kernels.hpp"
#include "device/device_state.hpp"
#include "device/record_kernels.hpp"
#include "device/reserve.hpp"
#include "expression/expression.hpp"
#include "expression/program.hpp"
#include "storage/cell_scan.hpp"
#include "storage/container_storage.hpp"

namespace cellist::detail {

/// What one search leaves to the next.
struct NeighbourMemory {
    std::shared_ptr<DeviceState> device;
    ContiguousLists lists = {};
    Memory counts = {};
    Memory cells = {};
    std::optional<CellScan> scan = {};
    std::uint64_t scanned = 0;  ///< counts that the scan sums
};

namespace {

/// Records that a work-item compares with those of a cell at once, and the most bytes of them.
constexpr std::size_t candidates_max = 256;
constexpr std::size_t candidates_bytes_max = 16384;
/// Larger records are not copied.
constexpr std::size_t copied_bytes_max = 256;

/// The source's definitions. A work-item has a cell if there are candidates.
struct SearchProgram {
    ExpressionProgram expressions;
    std::string definitions;
    bool has_candidates;
};

SearchProgram program_of(const RecordKernels& kernels, const NeighbourOptions& options,
                         const std::string& index) {
    const std::vector<Subject> subjects{{"record", "(*cellist_record)"},
                                        {"other", "(*cellist_other)"}};
    check_expression(options.distance, "distance expression");
    check_values(options.values, subjects);
    const RecordType& record = kernels.record();
    const std::string type = "const " + record.type() + "*";
    SearchProgram program{
        .expressions = expression_program(
            options.values, {{.expression = options.distance,
                              .what = "distance expression",
                              .head = "static inline float cellist_distance(" + type +
                                      " cellist_record, " + type + " cellist_other,\n    ",
                              .before = "(float)",
                              .subjects = subjects}}),
        .definitions = {},
        .has_candidates =
            kernels.owner()->info.one_thread_per_work_group && record.size <= copied_bytes_max};
    program.definitions =
        "#define CELLIST_INDEX(node) " +
        (index.empty() ? std::string("(node)") : "(cellist_get(lists, node)." + index + ")") + "\n";
    if (program.has_candidates)
        program.definitions +=
            "#define CELLIST_CANDIDATES " +
            std::to_string(std::min(candidates_max, candidates_bytes_max / record.size)) + "u\n";
    program.definitions += program.expressions.source;
    return program;
}

/// A search, from one pass to the other.
class Search {
public:
    Search(const ListsCore& lists, const NeighbourOptions& options, const std::string& index,
           NeighbourMemory& memory)
        : lists_(lists),
          options_(options),
          kernels_(lists.storage().kernels()),
          program_(program_of(kernels_, options, index)),
          memory_(memory) {
        lists.require_not_building();
        lists.make_ready();
        records_ = lists.storage().in_use().stored();
    }

    [[nodiscard]] std::uint64_t records() const { return records_; }

    /// Counts the neighbours of each record. Returns the sum. Blocks.
    std::uint64_t count() {
        memory_.lists.update(lists_);
        reserve(memory_.counts, lists_.device(), records_, sizeof(cl_uint), "counts of neighbours");
        if (!program_.has_candidates) find_cells();
        constexpr cl_uint zero = 0;
        memory_.counts.fill(&zero, sizeof zero, records_ * sizeof zero);
        run(false, memory_.counts, memory_.counts);

        if (!memory_.scan || memory_.scanned != records_)
            memory_.scan.emplace(MemoryOwner(lists_.device()), records_, 0);
        memory_.scanned = records_;
        CellScan::Totals totals;
        ReadbackFence fence;
        memory_.scan->sum(memory_.counts.cl(), CELLIST_NONE);
        fence.add(memory_.scan->read_later(totals));
        fence.wait();
        return totals.sum;
    }

    /// Writes the rows of the records. Call count() first.
    void store(std::uint64_t pairs, const Memory& offsets, const Memory& indices) {
        memory_.scan->write_offsets(memory_.counts.cl(), offsets.cl(), pairs);
        if (pairs > 0) run(true, offsets, indices);
    }

private:
    void find_cells() {
        reserve(memory_.cells, lists_.device(), records_, sizeof(cl_uint), "cells of records");
        Arguments arguments;
        memory_.lists.add_to(arguments, lists_);
        arguments.add(memory_.cells);
        kernel("cellist_cells_of_records").enqueue(cells(), arguments);
    }

    void run(bool stores, const Memory& offsets, const Memory& indices) {
        Arguments arguments;
        memory_.lists.add_to(arguments, lists_);
        arguments.add(static_cast<cl_uint>(options_.radius_cells));
        arguments.add(options_.radius);
        arguments.append(program_.expressions.values);
        arguments.add(static_cast<cl_uint>(stores ? 1 : 0));
        arguments.add(memory_.counts);
        arguments.add(offsets);
        arguments.add(indices);
        if (!program_.has_candidates) {
            arguments.add(static_cast<cl_uint>(records_));
            arguments.add(memory_.cells);
        }
        kernel("cellist_neighbours")
            .enqueue(program_.has_candidates ? cells() : Range::padded(records_), arguments);
    }

    Kernel& kernel(const char* name) {
        return kernels_.get({{"neighbours.cl", kernels::neighbours_cl}}, name, CELLIST_CONTIGUOUS,
                            program_.definitions, program_.expressions.types);
    }

    [[nodiscard]] Range cells() const { return Range::padded(lists_.shape().cells(), 64); }

    const ListsCore& lists_;
    const NeighbourOptions& options_;
    RecordKernels& kernels_;
    SearchProgram program_;
    NeighbourMemory& memory_;
    std::uint64_t records_ = 0;
};

}  // namespace

void find_neighbours(const ListsCore& lists, const NeighbourOptions& options,
                     const std::string& index, Neighbours& found) {
    if (!found.memory || found.memory->device != lists.device())
        found.memory = std::make_shared<NeighbourMemory>(lists.device());
    Search search(lists, options, index, *found.memory);
    const std::uint64_t pairs = search.count();
    if (pairs > std::numeric_limits<cl_uint>::max())
        throw MemoryError("the records have " + std::to_string(pairs) +
                          " pairs of neighbours, and an offset counts 4294967295 at most: lower "
                          "the radius");
    found.offsets.reserve(lists.device(), search.records() + 1);
    // The first search takes exactly what it needs; later ones some more, as pairs come and go.
    found.indices.reserve(lists.device(), found.pairs == 0 ? pairs : pairs + pairs / 16);
    search.store(pairs, found.offsets.memory(), found.indices.memory());
    found.records = search.records();
    found.pairs = pairs;
}

}  // namespace cellist::detail
