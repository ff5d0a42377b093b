#pragma once

#include <memory>

#include <cellist/options.hpp>

#include "method.hpp"

namespace oit {

/// The method that keeps fragments in cellist::Lists with these options.
[[nodiscard]] std::unique_ptr<Method> make_list_method(FragmentSource& source,
                                                       const cellist::ListsOptions& options);

}  // namespace oit
