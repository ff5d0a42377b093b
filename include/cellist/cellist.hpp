// SPDX-License-Identifier: MIT
#pragma once
// cellist: concurrent per-cell lists for OpenCL devices.

#include <cellist/buffer.hpp>
#include <cellist/device.hpp>
#include <cellist/error.hpp>
#include <cellist/host_lists.hpp>
#include <cellist/kernel.hpp>
#include <cellist/lists.hpp>
#include <cellist/neighbours.hpp>
#include <cellist/options.hpp>
#include <cellist/pending.hpp>
#include <cellist/range.hpp>
#include <cellist/report.hpp>
#include <cellist/shape.hpp>
#include <cellist/struct.hpp>
#include <cellist/types.hpp>
#include <cellist/value.hpp>
