#pragma once

#include <optional>

#include "cell_scan.hpp"
#include "storage.hpp"

namespace cellist::detail {

/// Builds in which the demand grows with every pass end here: the kernel does not repeat itself.
inline constexpr std::uint32_t passes_max = 8;

/// What a build throws then.
[[nodiscard]] inline OverflowError repeats_error(const BuildReport& report) {
    return {"the kernel inserted more records in each of " + std::to_string(passes_max) +
                " passes: it must insert the same records every time",
            report};
}

/// A head a cell and a pool of nodes with links; one pass.
class LinkedStorage final : public ListStorage {
public:
    LinkedStorage(std::shared_ptr<DeviceState> device, const Definitions& definitions,
                  const Shape& shape, const ListsOptions& options);
    void clear() override;
    BuildReport build(const std::function<void()>& insert) override;
    void recover() override;
    Validation validate() override;

private:
    std::optional<Kernel> validate_;
};

/// Two passes over the same kernels, count and fill; the lists lie behind one another.
class CountedStorage final : public ListStorage {
public:
    CountedStorage(std::shared_ptr<DeviceState> device, const Definitions& definitions,
                   const Shape& shape, const ListsOptions& options);
    void clear() override;
    BuildReport build(const std::function<void()>& insert) override;
    void recover() override;
    Validation validate() override;

private:
    void clear_counts();
    [[nodiscard]] cl_uint counts_at() const { return static_cast<cl_uint>(shape_.cells() + 1); }
    [[nodiscard]] std::uint64_t cells_not_filled();

    CellScan scan_;
    std::optional<Kernel> repeats_;
};

/// A number of slots for each cell; one pass.
class FixedStorage final : public ListStorage {
public:
    FixedStorage(std::shared_ptr<DeviceState> device, const Definitions& definitions,
                 const Shape& shape, const ListsOptions& options);
    void clear() override;
    BuildReport build(const std::function<void()>& insert) override;
    void recover() override;
    Validation validate() override;

private:
    void set_slots(std::uint64_t slots);
    [[nodiscard]] std::uint64_t nodes_with(std::uint64_t slots) const;

    CellScan scan_;
};

}  // namespace cellist::detail
