// SPDX-License-Identifier: MIT
#include "storage/container_storage.hpp"

namespace cellist::detail {

std::string ContainerStorage::reason() const {
    return std::string(name_of(storage_->kind())) + ": named in the options";
}

}  // namespace cellist::detail
