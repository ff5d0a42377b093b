// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include <cellist/detail/lists_core.hpp>

#include "storage/storage.hpp"

namespace cellist::detail {

/// The records that a build keeps.
struct ListsCore::Append {
    bool is_marked = false;  ///< they stay where they are, and the storage can return to them
    std::unique_ptr<PackedLists> copy = {};  ///< null if they stay, or nothing has changed
};

}  // namespace cellist::detail
