// SPDX-License-Identifier: MIT
#include "operations.hpp"

namespace cellist::test {

std::vector<Operation> operations() {
    std::vector<Operation> all;
    for (const auto& table :
         {object_operations(), build_operations(), sort_operations(), read_operations()})
        all.insert(all.end(), table.begin(), table.end());
    return all;
}

}  // namespace cellist::test
