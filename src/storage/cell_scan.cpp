// SPDX-License-Identifier: MIT
#include "storage/cell_scan.hpp"

#include <algorithm>
#include <bit>
#include <string>

#include "cellist_kernels.hpp"
#include "device/device_state.hpp"

namespace cellist::detail {

namespace {

constexpr std::size_t group_max = 256;
// As in scan.cl.
constexpr std::size_t cells_of_item = 16;

cl_uint group_of(const DeviceInfo& device) {
    return static_cast<cl_uint>(
        std::min(group_max, std::bit_floor(std::max<std::size_t>(device.max_work_group_size, 1))));
}

Kernel scan_kernel(const std::shared_ptr<DeviceState>& device, cl_uint group, const char* name) {
    return {device,
            Source{.text = "#define CELLIST_SCAN_GROUP " + std::to_string(group) +
                           "\n#line 1 \"scan.cl\"\n" + std::string(kernels::scan_cl),
                   .file_name = "scan.cl"},
            name,
            {}};
}

std::uint64_t tiles_of(std::uint64_t cells, cl_uint group) {
    return cells / (group * cells_of_item) + 1;
}

Range tiles_range(std::uint64_t tiles, std::size_t group) {
    Range range(tiles * group);
    range.local = {group, 1, 1};
    return range;
}

}  // namespace

CellScan::CellScan(const MemoryOwner& device, std::uint64_t cells, cl_uint counts_at)
    : group_(group_of(device->info)),
      cells_(static_cast<cl_uint>(cells)),
      counts_at_(counts_at),
      tiles_(tiles_of(cells, group_)),
      tile_sums_(scan_kernel(device, group_, "cellist_tile_sums")),
      tile_starts_(scan_kernel(device, group_, "cellist_tile_starts")),
      tile_offsets_(scan_kernel(device, group_, "cellist_tile_offsets")),
      sums_(device, tiles_, sizeof(cl_ulong), "sums"),
      hashes_(device, tiles_, sizeof(cl_ulong), "hashes"),
      maxima_(device, tiles_, sizeof(cl_uint), "maxima"),
      totals_(device, 1, sizeof(Totals), "totals") {}

std::uint64_t CellScan::bytes_for(const DeviceInfo& device, std::uint64_t cells) {
    return tiles_of(cells, group_of(device)) * (2 * sizeof(cl_ulong) + sizeof(cl_uint)) +
           sizeof(Totals);
}

void CellScan::sum(const cl::Buffer& heads, cl_uint limit) {
    tile_sums_.run(tiles_range(tiles_, group_), heads, counts_at_, cells_, limit, sums_.cl(),
                   hashes_.cl(), maxima_.cl());
    tile_starts_.run(tiles_range(1, group_), sums_.cl(), hashes_.cl(), maxima_.cl(),
                     static_cast<cl_uint>(tiles_), totals_.cl());
}

PendingRead CellScan::read_later(Totals& totals) const {
    return totals_.read_later(&totals, sizeof totals);
}

void CellScan::write_offsets(const cl::Buffer& heads, const cl::Buffer& offsets,
                             std::uint64_t capacity_nodes, const Memory* kept) {
    const bool keeps = kept != nullptr;
    tile_offsets_.run(tiles_range(tiles_, group_), heads, counts_at_, cells_, sums_.cl(),
                      static_cast<cl_uint>(capacity_nodes), keeps ? kept->cl() : heads,
                      cl_uint{keeps}, offsets);
}

}  // namespace cellist::detail
