// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "methods/lists.hpp"

namespace oit {

/// The method that keeps lists within Frame::memory_bytes. It takes the pixels in slices, and
/// builds, sorts (if the reader needs it), reads and forgets the lists of each slice
/// (cellist::Lists::build_slices). Its store() throws InputError, with the least that works, if the
/// bound leaves no room for the longest list.
[[nodiscard]] std::unique_ptr<Method> make_list_slices(FragmentSource& source,
                                                       const cellist::ListsOptions& options,
                                                       const ListReader& reader);

}  // namespace oit
