#include <algorithm>

#include "cellist_kernels.hpp"
#include "storages.hpp"

namespace cellist::detail {

namespace {

/// As cellist_piece_findings in pieces.cl.
struct PieceFindings {
    cl_uint broken_places;
    cl_uint unfilled_cells;
    cl_uint first_bad_cell;
};

}  // namespace

CountedStorage::CountedStorage(std::shared_ptr<DeviceState> device, const Definitions& definitions,
                               const Shape& shape, const ListsOptions& options)
    : ListStorage(std::move(device), definitions, shape, options, CELLIST_CONTIGUOUS,
                  definitions.records.back().size, 2 * shape.cells() + 1),
      scan_(device_, shape.cells(), counts_at()) {
    const std::uint64_t capacity = options.capacity_nodes.value_or(0);
    if (const auto reason = refusal(capacity)) throw Error(*reason);
    allocate_pool(capacity);
    clear();
}

void CountedStorage::clear() {
    constexpr cl_uint zero = 0;
    heads_.fill(&zero, sizeof zero, heads_.size_bytes());
    clear_counters();
}

void CountedStorage::clear_counts() {
    if (shape_.cells() == 0) return;
    constexpr cl_uint zero = 0;
    const cl_int code = clEnqueueFillBuffer(device_->queue(), heads_.cl()(), &zero, sizeof zero,
                                            counts_at() * sizeof(cl_uint),
                                            shape_.cells() * sizeof(cl_uint), 0, nullptr, nullptr);
    if (code != CL_SUCCESS) throw OpenClError("clEnqueueFillBuffer", code);
}

void CountedStorage::begin_pass() {
    if (!counted_) {
        clear();
        mode_ = CELLIST_COUNTING;
    } else {
        clear_counts();
        clear_counters();
    }
}

bool CountedStorage::end_pass(BuildReport& report) {
    mode_ = CELLIST_CONTIGUOUS;
    const Counters counters = read_counters();
    if (!counted_) {
        counters_ = counters;
        place_lists(report);
        counted_ = true;
        return false;
    }
    update(report, counters, kept_);
    check_repeats(counters);
    return true;
}

/// After the counting pass: makes room for all records, or decides which cells go short.
void CountedStorage::place_lists(BuildReport& report) {
    const CellScan::Sums sums = scan_.sums(heads_.cl(), CELLIST_NONE);
    demand_ = sums.total + counters_.dropped;
    kept_ = std::min(demand_, capacity_nodes_);
    update(report, counters_, kept_);
    report.dropped = demand_ - kept_;
    report.attempted = demand_ + counters_.rejected;
    if (kept_ < demand_ && options_.overflow != Overflow::drop) {
        require(demand_, report);
        allocate_pool(demand_);
        kept_ = demand_;
    }
    scan_.write_offsets(heads_.cl(), sums, capacity_nodes_);
}

void CountedStorage::check_repeats(const Counters& filled) {
    if (validate().ok() && filled.dropped == demand_ - kept_ &&
        filled.rejected == counters_.rejected)
        return;
    throw Error(
        "the kernel inserted other records when it filled the lists than when it counted them: it "
        "must insert the same records every time, or use Storage::linked");
}

Validation CountedStorage::validate() {
    PieceFindings findings{0, 0, CELLIST_NONE};
    Memory device_findings(device_, 1, sizeof findings, "findings");
    device_findings.write(&findings, sizeof findings);
    if (!pieces_) pieces_.emplace(kernel("cellist_pieces", kernels::pieces_cl));
    Arguments arguments;
    add_to(arguments);
    arguments.add(device_findings.cl());
    pieces_->enqueue(Range::padded(shape_.cells()), arguments);
    device_findings.read(&findings, sizeof findings);
    return {findings.broken_places, 0, findings.unfilled_cells, findings.first_bad_cell};
}

void CountedStorage::recover() {
    counted_ = false;
    mode_ = CELLIST_CONTIGUOUS;
    if (!has_pool()) allocate_pool(0);
}

}  // namespace cellist::detail
