// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include <cellist/detail/memory.hpp>

#include "device/device_state.hpp"
#include "device/view.hpp"

namespace cellist::detail {

/// Memory where a single pass leaves records by the partitions of their cells. The threads of a
/// processor have blocks of their own for each partition. On GPUs, a partition has a region.
/// counted.clh describes mode PARTITIONED.
class Partitions {
public:
    struct Plan {
        std::uint64_t records = 0;  ///< that fit if one thread per compute unit runs
        std::uint64_t nodes = 0;    ///< of whole blocks
        std::size_t node_bytes = 0;
        cl_uint thread_slots = 0;  ///< of threads
        cl_uint bits = 0;          ///< 2^bits cells are a partition
        cl_uint partitions = 0;
        cl_uint sorted_records = 0;  ///< of a region that a work-group sorts; 0 for blocks
        cl_uint staged_records = 0;  ///< of these in local memory at a time

        [[nodiscard]] bool has_regions() const { return sorted_records > 0; }
        /// Room of a region at most.
        [[nodiscard]] cl_uint region_records_most() const;
        /// Words of the heads that are 0 before a pass.
        [[nodiscard]] std::uint64_t words_to_clear() const;
        [[nodiscard]] std::uint64_t head_words() const;
        [[nodiscard]] std::uint64_t bytes() const;
    };
    /// For an eighth more records than these. None on devices that are neither GPUs nor processors
    /// with such threads, and where limits or so few records forbid it.
    [[nodiscard]] static std::optional<Plan> plan(const DeviceInfo& device, std::size_t node_bytes,
                                                  std::size_t record_bytes, std::uint64_t cells,
                                                  std::uint64_t records);

    /// Null where the device has no memory for it.
    [[nodiscard]] static std::unique_ptr<Partitions> make(const MemoryOwner& device,
                                                          const Plan& plan);

    [[nodiscard]] const Plan& plan() const { return plan_; }
    [[nodiscard]] const Memory& nodes() const { return nodes_; }
    [[nodiscard]] const Memory& heads() const { return heads_; }
    /// The number of records, then where the lists of each partition start.
    [[nodiscard]] const Memory& starts() const { return starts_; }

private:
    Partitions(const MemoryOwner& device, const Plan& plan);

    Plan plan_;
    Memory nodes_;
    Memory heads_;
    Memory starts_;
};

}  // namespace cellist::detail
