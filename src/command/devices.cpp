// SPDX-License-Identifier: MIT
#include "devices.hpp"

#include <algorithm>
#include <array>
#include <iomanip>
#include <ostream>
#include <sstream>
#include <string>
#include <vector>

#include <cellist/device.hpp>
#include <cellist/error.hpp>

namespace cellist::command {

namespace {

std::string size_text(std::uint64_t bytes) {
    std::ostringstream text;
    if (bytes >= std::uint64_t{1} << 30)
        text << std::fixed << std::setprecision(1)
             << static_cast<double>(bytes) / static_cast<double>(std::uint64_t{1} << 30) << " GiB";
    else
        text << (bytes >> 10) << " KiB";
    return text.str();
}

}  // namespace

int devices(std::ostream& out) {
    const std::vector<DeviceInfo> infos = Device::all();
    if (infos.empty())
        throw Error(
            "no OpenCL device found: install a driver, or PoCL for the CPU "
            "(pocl-opencl-icd)");

    constexpr std::size_t columns = 9;
    using Row = std::array<std::string, columns>;
    std::vector<Row> rows{{"#", "name", "platform", "driver", "memory", "one buffer", "local",
                           "atomics", "sub-groups"}};
    for (std::size_t i = 0; i < infos.size(); ++i) {
        const DeviceInfo& info = infos[i];
        rows.push_back({std::to_string(i), info.name, info.platform, info.driver,
                        size_text(info.global_memory_bytes), size_text(info.max_allocation_bytes),
                        size_text(info.local_memory_bytes),
                        info.int64_atomics ? "32, 64 bit" : "32 bit",
                        info.sub_groups ? "yes" : "no"});
    }

    std::array<std::size_t, columns> widths{};
    for (const Row& row : rows)
        for (std::size_t i = 0; i < columns; ++i) widths[i] = std::max(widths[i], row[i].size());
    for (const Row& row : rows) {
        std::ostringstream line;
        for (std::size_t i = 0; i < columns; ++i)
            line << std::left << std::setw(static_cast<int>(widths[i] + 2)) << row[i];
        std::string text = line.str();
        text.erase(text.find_last_not_of(' ') + 1);
        out << text << '\n';
    }
    return 0;
}

}  // namespace cellist::command
