#pragma once

#include <optional>

#include "cell_scan.hpp"
#include "storage.hpp"

namespace cellist::detail {

/// A head a cell and a pool of nodes with links; one pass.
class LinkedStorage final : public ListStorage {
public:
    LinkedStorage(std::shared_ptr<DeviceState> device, const Definitions& definitions,
                  const Shape& shape, const ListsOptions& options);
    void clear() override;
    void begin_pass() override { clear(); }
    bool end_pass(BuildReport& report) override;
    void recover(bool without_pool) override;
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
    void start() override { counted_ = false; }
    void begin_pass() override;
    bool end_pass(BuildReport& report) override;
    void recover(bool without_pool) override;
    Validation validate() override;

private:
    void place_lists(BuildReport& report);
    void check_repeats(const Counters& filled);
    [[nodiscard]] cl_uint counts_at() const { return static_cast<cl_uint>(shape_.cells() + 1); }

    CellScan scan_;
    bool counted_ = false;      ///< the next pass fills
    Counters counters_;         ///< of the counting pass
    std::uint64_t demand_ = 0;  ///< records that the counting pass saw inside the shape
    std::uint64_t kept_ = 0;    ///< those of them that fit
    std::optional<Kernel> validate_;
};

/// A number of slots for each cell; one pass.
class FixedStorage final : public ListStorage {
public:
    FixedStorage(std::shared_ptr<DeviceState> device, const Definitions& definitions,
                 const Shape& shape, const ListsOptions& options);
    void clear() override;
    void begin_pass() override { clear(); }
    bool end_pass(BuildReport& report) override;
    void recover(bool without_pool) override;
    Validation validate() override;

private:
    void set_slots(std::uint64_t slots);
    [[nodiscard]] std::uint64_t nodes_with(std::uint64_t slots) const;

    CellScan scan_;
    std::uint64_t stored_ = 0;  ///< records that the last build left in the lists
};

}  // namespace cellist::detail
