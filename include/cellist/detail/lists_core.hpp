#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <cellist/detail/memory.hpp>
#include <cellist/detail/record_type.hpp>
#include <cellist/kernel.hpp>
#include <cellist/options.hpp>
#include <cellist/report.hpp>
#include <cellist/shape.hpp>

namespace cellist::detail {

/// Lists without the record's C++ type: heads, a pool of nodes, counters, and the kernels that work
/// on them. The kernels see the record by its name in OpenCL C.
class ListsCore {
public:
    ListsCore(std::shared_ptr<DeviceState> device, Definitions definitions, const Shape& shape,
              const ListsOptions& options);

    BuildReport build(const std::function<void()>& insert);
    void clear();
    cl::Event sort(const std::string& key);
    [[nodiscard]] Lengths lengths() const;
    [[nodiscard]] Validation validate() const;

    /// Calls `allocate` with the number of records, writes the records to where it points, and
    /// returns the offset of each cell's first record and the end.
    [[nodiscard]] std::vector<std::uint64_t> download(
        const std::function<void*(std::uint64_t)>& allocate) const;

    [[nodiscard]] const Shape& shape() const { return shape_; }
    [[nodiscard]] std::uint64_t capacity_nodes() const { return capacity_nodes_; }
    [[nodiscard]] std::uint64_t pool_bytes() const;

    /// Adds what CELLIST_LISTS declares.
    void add_to(Arguments& arguments) const;

private:
    struct Counters {
        std::uint64_t stored = 0;
        std::uint64_t dropped = 0;
        std::uint64_t rejected = 0;
    };

    [[nodiscard]] std::uint64_t bytes_with(std::uint64_t capacity_nodes) const;
    [[nodiscard]] std::optional<std::string> refusal(std::uint64_t capacity_nodes) const;
    void allocate_pool(std::uint64_t capacity_nodes);
    void empty_after_failure() noexcept;
    [[nodiscard]] Counters read_counters() const;
    Kernel& kernel(const std::string& name, std::string_view source,
                   const std::string& key = {}) const;
    [[nodiscard]] Range cell_range() const;
    [[nodiscard]] std::vector<cl_uint> cell_lengths() const;

    std::shared_ptr<DeviceState> device_;
    Definitions definitions_;
    Shape shape_;
    ListsOptions options_;
    NodeLayout node_;
    std::uint64_t capacity_nodes_ = 0;
    std::uint32_t shard_bits_ = 0;
    Memory heads_;
    Memory nodes_;
    Memory shards_;
    mutable std::map<std::string, Kernel> kernels_;  ///< the library's, by name and key
};

}  // namespace cellist::detail
