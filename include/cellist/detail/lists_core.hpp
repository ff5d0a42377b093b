#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <cellist/detail/memory.hpp>
#include <cellist/detail/record_type.hpp>
#include <cellist/kernel.hpp>
#include <cellist/options.hpp>
#include <cellist/report.hpp>
#include <cellist/shape.hpp>

namespace cellist::detail {

class ListStorage;

/// Lists without the record's C++ type: a storage, and the kernels that read and sort any storage.
/// The kernels see the record by its name in OpenCL C.
class ListsCore {
public:
    ListsCore(std::shared_ptr<DeviceState> device, Definitions definitions, const Shape& shape,
              const ListsOptions& options);
    ListsCore(ListsCore&&) noexcept;
    ListsCore& operator=(ListsCore&&) noexcept;
    ~ListsCore();

    /// Builds all containers at once: `insert` runs the kernels that fill them. A report each.
    static std::vector<BuildReport> build(std::span<ListsCore* const> containers,
                                          const std::function<void()>& insert);
    void clear();
    cl::Event sort(const std::string& key, Order order);
    [[nodiscard]] Lengths lengths() const;
    [[nodiscard]] Validation validate() const;

    /// Calls `allocate` with the number of records, writes the records to where it points, and
    /// returns the offset of each cell's first record and the end.
    [[nodiscard]] std::vector<std::uint64_t> download(
        const std::function<void*(std::uint64_t)>& allocate) const;

    /// Writes cells + 1 offsets, calls `allocate` with the number of records, and copies the lists to
    /// the buffer that it returns, one behind the other.
    void pack(const cl::Buffer& offsets,
              const std::function<const cl::Buffer&(std::uint64_t)>& allocate) const;

    [[nodiscard]] const Shape& shape() const { return shape_; }
    [[nodiscard]] std::uint64_t capacity_nodes() const;
    [[nodiscard]] std::uint64_t pool_bytes() const;
    [[nodiscard]] const std::shared_ptr<DeviceState>& device() const { return device_; }
    /// The mode in which the lists are read, as in view.h.
    [[nodiscard]] unsigned mode() const;

    /// Adds what CELLIST_LISTS declares.
    void add_to(Arguments& arguments) const;

private:
    void empty_after_failure(bool without_pool) noexcept;
    void settle() const;
    Kernel& kernel(const std::string& name, std::string_view source,
                   const std::string& key_function = {}) const;
    [[nodiscard]] Range cell_range() const;
    struct Offsets {
        Memory words;
        std::uint64_t total;
    };
    [[nodiscard]] Memory device_lengths(std::uint64_t at) const;
    [[nodiscard]] Offsets device_offsets() const;
    void gather(std::uint64_t begin, std::uint64_t end, const Offsets& offsets,
                const cl::Buffer& records) const;

    std::shared_ptr<DeviceState> device_;
    Definitions definitions_;
    Shape shape_;
    std::unique_ptr<ListStorage> storage_;
    mutable bool unsettled_ =
        false;                   ///< lists in no order: settle() has not succeeded since a failure
    bool without_pool_ = false;  ///< how it has to settle
    mutable std::map<std::string, Kernel> kernels_;  ///< the library's, by name and key
};

}  // namespace cellist::detail
