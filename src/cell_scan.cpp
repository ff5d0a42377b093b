#include "cell_scan.hpp"

#include "cellist_kernels.hpp"
#include "device_state.hpp"

namespace cellist::detail {

namespace {

// As in scan.cl.
constexpr std::size_t group = 256;
constexpr std::size_t cells_of_item = 16;

Kernel scan_kernel(const std::shared_ptr<DeviceState>& device, const char* name) {
    return {
        device, Source{.text = std::string(kernels::scan_cl), .file_name = "scan.cl"}, name, {}};
}

Range blocks_range(std::uint64_t blocks) {
    Range range(blocks * group);
    range.local = {group, 1, 1};
    return range;
}

}  // namespace

CellScan::CellScan(std::shared_ptr<DeviceState> device, std::uint64_t cells, cl_uint counts_at)
    : device_(std::move(device)),
      cells_(static_cast<cl_uint>(cells)),
      counts_at_(counts_at),
      blocks_(cells / (group * cells_of_item) + 1),
      block_sums_(scan_kernel(device_, "cellist_block_sums")),
      block_starts_(scan_kernel(device_, "cellist_block_starts")),
      block_offsets_(scan_kernel(device_, "cellist_block_offsets")),
      sums_(device_, blocks_, sizeof(cl_ulong), "sums"),
      maxima_(device_, blocks_, sizeof(cl_uint), "maxima"),
      totals_(device_, 1, sizeof(Totals), "totals") {}

void CellScan::sum(const cl::Buffer& heads, cl_uint limit) {
    block_sums_.run(blocks_range(blocks_), heads, counts_at_, cells_, limit, sums_.cl(),
                    maxima_.cl());
    block_starts_.run(blocks_range(1), sums_.cl(), maxima_.cl(), static_cast<cl_uint>(blocks_),
                      totals_.cl());
}

Reading CellScan::read_later(Totals& totals) const {
    return totals_.read_later(&totals, sizeof totals);
}

void CellScan::write_offsets(const cl::Buffer& heads, std::uint64_t capacity_nodes) {
    block_offsets_.run(blocks_range(blocks_), heads, counts_at_, cells_, sums_.cl(),
                       static_cast<cl_uint>(capacity_nodes));
}

}  // namespace cellist::detail
