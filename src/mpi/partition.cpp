// SPDX-License-Identifier: MIT
#include <cstdlib>
#include <string>

#include <cellist/mpi.hpp>

#include "device/device_state.hpp"
#include "mpi/partition_plan.hpp"

namespace cellist::mpi {

Device choose(MPI_Comm comm) {
    const detail::Communicator communicator(comm);
    const char* variable = std::getenv("CELLIST_DEVICE");
    const std::string selector = variable == nullptr ? "" : variable;
    const int turn = communicator.turn_on_host(selector);
    std::optional<Device> device;
    communicator.together([&] {
        std::vector<std::size_t> devices;
        if (!selector.empty()) {
            devices = detail::devices_called(selector);
        } else {
            const std::vector<DeviceInfo> all = Device::all();
            for (std::size_t i = 0; i < all.size(); ++i)
                if (all[i].is_gpu()) devices.push_back(i);
        }
        device = devices.empty() ? Device::choose()
                                 : Device::choose(std::to_string(
                                       devices[static_cast<std::size_t>(turn) % devices.size()]));
    });
    return std::move(*device);
}

Partition::Partition(MPI_Comm comm, const Shape& shape, const PartitionOptions& options)
    : Partition(std::make_shared<detail::PartitionPlan>(comm, shape, options, nullptr)) {}

Partition Partition::balanced(MPI_Comm comm, const Shape& shape,
                              const std::vector<std::uint64_t>& weights,
                              const PartitionOptions& options) {
    return Partition(std::make_shared<detail::PartitionPlan>(comm, shape, options, &weights));
}

const Shape& Partition::shape() const { return plan_->shape(); }
const PartitionOptions& Partition::options() const { return plan_->options(); }
int Partition::rank() const { return plan_->communicator().rank(); }
int Partition::ranks() const { return plan_->communicator().size(); }
const Block& Partition::block(int rank) const { return plan_->block(rank); }
std::array<std::uint64_t, 4> Partition::ghosts() const { return plan_->ghosts(); }

int Partition::owner(std::uint64_t cell) const {
    if (cell >= shape().cells())
        throw Error("cell " + std::to_string(cell) + " is outside of the shape " +
                    shape().to_string());
    return plan_->owner(plan_->position(cell));
}

Shape Partition::local_shape() const {
    return detail::shape_of(plan_->held(rank()), shape().dimensions());
}

std::optional<std::uint64_t> Partition::local_cell(std::uint64_t cell) const {
    if (cell >= shape().cells()) return {};
    const detail::Position at = plan_->position(cell), held = plan_->held(rank());
    std::uint64_t local = 0;
    for (std::size_t axis = 4; axis-- > 0;) {
        const std::uint64_t inside = at[axis] - block().origin[axis];
        if (inside >= block().extent[axis]) return {};
        local = local * held[axis] + inside + plan_->ghosts()[axis];
    }
    return local;
}

std::optional<std::uint64_t> Partition::cell(std::uint64_t local_cell) const {
    const detail::Position held = plan_->held(rank());
    if (block().cells() == 0) return {};
    detail::Position at{};
    for (std::size_t axis = 0; axis < 4; ++axis) {
        const std::uint64_t inside = local_cell % held[axis] - plan_->ghosts()[axis];
        if (inside >= block().extent[axis]) return {};
        at[axis] = block().origin[axis] + inside;
        local_cell /= held[axis];
    }
    if (local_cell > 0) return {};
    return plan_->cell(at);
}

}  // namespace cellist::mpi
