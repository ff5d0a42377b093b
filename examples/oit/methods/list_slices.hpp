#pragma once

#include <memory>

#include "methods/list_method.hpp"

namespace oit {

/// The method that keeps lists within Frame::memory_bytes: it takes the pixels in slices, and
/// builds, sorts (or not), reads and forgets the lists of each (cellist::Lists::build_slices). Its
/// store() throws InputError, with the least that works, where the bound leaves no room for the
/// longest list.
[[nodiscard]] std::unique_ptr<Method> make_list_slices(FragmentSource& source,
                                                       const cellist::ListsOptions& options,
                                                       const ListReader& reader, bool sorts);

}  // namespace oit
