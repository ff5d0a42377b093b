// SPDX-License-Identifier: MIT
#include "tune/measure.hpp"

#include <array>
#include <chrono>

#include "cellist_kernels.hpp"
#include "device/device_state.hpp"

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

BuildReport measure(const ContainerStorage& container, const std::function<BuildReport()>& run,
                    Measurement& measurement) {
    RecordKernels& record_kernels = container.kernels();
    const DeviceState& device = *record_kernels.owner();
    BuildReport report;
    measurement.cost.build_seconds = seconds(device, [&] { report = run(); });
    measurement.stored = report.stored;

    const ListStorage& storage = container.in_use();
    std::array<cl_uint, 2> found{};
    Memory findings(record_kernels.owner().state(), found.size(), sizeof(cl_uint), "findings");
    findings.write(found.data(), sizeof found);
    Arguments arguments;
    storage.add_to(arguments);
    arguments.add(cl_uint{traverse_most});
    arguments.add(findings.cl());
    const bool words = record_kernels.record().alignment % sizeof(cl_uint) == 0;
    Kernel& traverse = record_kernels.get(
        {{"traverse.cl", kernels::traverse_cl}}, "cellist_traverse", storage.mode(),
        words ? "#define CELLIST_WORD uint\n" : "#define CELLIST_WORD uchar\n");
    const Range cells = Range::padded(storage.cells());
    measurement.cost.read_seconds = seconds(device, [&] { traverse.enqueue(cells, arguments); });
    findings.read(found.data(), sizeof found);
    measurement.longest = found[0];
    return report;
}

}  // namespace cellist::detail
