// SPDX-License-Identifier: MIT
#pragma once

#include <functional>

#include <cellist/report.hpp>

#include "storage/container_storage.hpp"
#include "tune/storage_tuner.hpp"

namespace cellist::detail {

/// Takes the time of a build of a container, which `run` does, and the time of a read of every
/// record. Blocks.
BuildReport measure(const ContainerStorage& container, const std::function<BuildReport()>& run,
                    Measurement& measurement);

}  // namespace cellist::detail
