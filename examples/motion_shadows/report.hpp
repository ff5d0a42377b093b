// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <iosfwd>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "measure.hpp"
#include "options.hpp"

namespace motion {

/// The results of a run.
struct Report {
    Options options;
    std::string device, driver;
    std::uint64_t triangles = 0;
    PaperSize paper;
    std::vector<Measurement> measurements;

    [[nodiscard]] std::uint64_t texels() const;
    [[nodiscard]] const Measurement* reference() const;
};

void print(std::ostream& out, const Report& report);

/// docs/motion-shadows.md has a table of the keys.
[[nodiscard]] nlohmann::ordered_json to_json(const Report& report);

/// A line for each measurement.
[[nodiscard]] std::string to_csv(const Report& report);

}  // namespace motion
