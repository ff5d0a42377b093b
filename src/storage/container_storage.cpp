#include "storage/container_storage.hpp"

#include <array>
#include <chrono>

#include "cellist_kernels.hpp"
#include "device/device_state.hpp"
#include "tune/automatic.hpp"
#include "tune/storage_tuner.hpp"

namespace cellist::detail {

namespace {

/// Seconds until all that `work` enqueues has run on the device.
template <class Work>
double seconds(const DeviceState& device, const Work& work) {
    const auto finish = [&] { opencl([&] { device.queue.finish(); }); };
    finish();
    const auto begin = std::chrono::steady_clock::now();
    work();
    finish();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

}  // namespace

std::string ContainerStorage::reason() const {
    return std::string(name_of(storage_->kind())) + ": named in the options";
}

BuildReport ContainerStorage::measure(const std::function<BuildReport()>& run,
                                      Measurement& measurement) {
    DeviceState& device = *kernels_.owner();
    BuildReport report;
    measurement.cost.build_seconds = seconds(device, [&] { report = run(); });
    measurement.stored = report.stored;

    std::array<cl_uint, 2> found{};
    Memory findings(kernels_.owner().state(), found.size(), sizeof(cl_uint), "findings");
    findings.write(found.data(), sizeof found);
    Arguments arguments;
    storage_->add_to(arguments);
    arguments.add(cl_uint{traverse_most});
    arguments.add(findings.cl());
    const bool words = kernels_.record().alignment % sizeof(cl_uint) == 0;
    Kernel& traverse =
        kernels_.get({{"traverse.cl", kernels::traverse_cl}}, "cellist_traverse", storage_->mode(),
                     words ? "#define CELLIST_WORD uint\n" : "#define CELLIST_WORD uchar\n");
    const Range cells = Range::padded(storage_->cells());
    measurement.cost.read_seconds = seconds(device, [&] { traverse.enqueue(cells, arguments); });
    findings.read(found.data(), sizeof found);
    measurement.longest = found[0];
    return report;
}

std::unique_ptr<ContainerStorage> make_container_storage(RecordKernels& kernels, const Shape& shape,
                                                         const ListsOptions& options) {
    if (options.storage == Storage::automatic)
        return std::make_unique<AutomaticStorage>(kernels, shape, options);
    return std::make_unique<ContainerStorage>(kernels, make_storage(kernels, shape, options));
}

}  // namespace cellist::detail
