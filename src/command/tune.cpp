// SPDX-License-Identifier: MIT
#include "tune.hpp"

#include <algorithm>
#include <bit>
#include <iomanip>
#include <ostream>
#include <sstream>
#include <string>

#include <cellist/cellist.hpp>

#include "device/profile.hpp"
#include "tune/measure.hpp"

namespace cellist::command {

struct TuneRecord {
    cl_uint words[3];
};
CELLIST_STRUCT(TuneRecord, words);

namespace {

constexpr auto tune_source = R"(
#include <cellist/lists.clh>

// The number of cells is a power of two.
kernel void tune_insert(CELLIST_LISTS(TuneRecord, lists), uint is_random)
{
    uint i = get_global_id(0);
    uint cell = i;
    if (is_random) {
        cell = (cell ^ cell >> 16) * 0x7feb352du;
        cell = (cell ^ cell >> 15) * 0x846ca68bu;
        cell ^= cell >> 16;
    }
    TuneRecord record = { { i, ~i, cell } };
    cellist_insert(lists, cell & (cellist_cells(lists) - 1), record);
}
)";

constexpr std::uint64_t occupancy = 16;
constexpr int builds = 5;  ///< the first one warms up

/// The number of records: more than caches hold, within an eighth of the device's memory.
std::uint64_t record_count(const DeviceInfo& device) {
    const std::uint64_t wanted = device.is_gpu() ? 1u << 24 : 1u << 22;
    // In Storage::fixed a cell may have slots for four times the mean.
    const std::uint64_t most =
        std::min(device.max_allocation_bytes, device.global_memory_bytes / 8) /
        (4 * sizeof(TuneRecord));
    return std::bit_floor(std::clamp<std::uint64_t>(most, 1024, wanted));
}

/// Measures the cost of a record: the least of all builds after the first.
detail::Cost measure(const Device& device, Storage storage, detail::Pattern pattern,
                     std::uint64_t records, std::uint32_t slots) {
    Lists<TuneRecord> lists(device, {records / occupancy},
                            {.storage = storage, .capacity_nodes = records, .slots = slots});
    Kernel insert(device, tune_source, "tune_insert", lists);
    const auto is_random = static_cast<cl_uint>(pattern == detail::Pattern::random);
    detail::Cost least;
    for (int i = 0; i < builds; ++i) {
        detail::Measurement trial;
        const BuildReport report = detail::measure(
            lists.core().storage(), [&] { return lists.build(insert, records, is_random); }, trial);
        if (report.stored != records)
            throw Error(std::to_string(report.stored) + " of " + std::to_string(records) +
                        " records were stored: run `cellist selftest` to find the fault");
        const double per_record = 1 / static_cast<double>(records);
        const detail::Cost cost{per_record * trial.cost.build_seconds,
                                per_record * trial.cost.read_seconds};
        if (i <= 1) least = cost;
        least = {std::min(least.build_seconds, cost.build_seconds),
                 std::min(least.read_seconds, cost.read_seconds)};
    }
    return least;
}

/// The length of the longest list that a pattern makes.
std::uint32_t longest(const Device& device, detail::Pattern pattern, std::uint64_t records) {
    if (pattern == detail::Pattern::coherent) return occupancy;
    Lists<TuneRecord> lists(device, {records / occupancy}, {.storage = Storage::counted});
    Kernel insert(device, tune_source, "tune_insert", lists);
    lists.build(insert, records, cl_uint{1});
    return static_cast<std::uint32_t>(lists.lengths().longest);
}

std::string nanoseconds(double seconds) {
    std::ostringstream text;
    text << std::fixed << std::setprecision(3) << 1e9 * seconds;
    return text.str();
}

}  // namespace

int tune(const Device& device, std::ostream& out) {
    const DeviceInfo& info = device.info();
    const std::uint64_t records = record_count(info);
    // Fail before the measurements if the profile cannot be written.
    const std::string path = detail::prepare_profile(info).string();
    out << info.name << " (" << info.platform << ", driver " << info.driver << ")\n"
        << records << " records of " << sizeof(TuneRecord) << " bytes in " << records / occupancy
        << " lists; nanoseconds per record\n"
        << "                 build      read\n";

    detail::Profile profile(records);
    for (const detail::Pattern pattern : detail::patterns) {
        const std::uint32_t slots = longest(device, pattern, records);
        for (const Storage storage : detail::choices) {
            const detail::Cost cost = measure(device, storage, pattern, records, slots);
            profile.set_cost(storage, pattern, cost);
            out << "  " << std::left << std::setw(9) << detail::name_of(pattern) << std::setw(8)
                << name_of(storage) << std::right << std::setw(9) << nanoseconds(cost.build_seconds)
                << std::setw(10) << nanoseconds(cost.read_seconds) << std::endl;
        }
    }
    detail::save_profile(info, profile);
    out << "written to " << path << '\n';
    return 0;
}

}  // namespace cellist::command
