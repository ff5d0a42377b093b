// SPDX-License-Identifier: MIT
#include "around/contiguous.hpp"

#include "device/reserve.hpp"
#include "storage/container_storage.hpp"

namespace cellist::detail {

void ContiguousLists::update(const ListsCore& lists) {
    ListStorage& storage = lists.storage().in_use();
    is_copy_ = storage.mode() != CELLIST_CONTIGUOUS;
    if (!is_copy_) return;
    const RecordType& record = lists.storage().kernels().record();
    reserve(offsets_, lists.device(), storage.cells() + 1, sizeof(cl_uint), "offsets of a copy");
    lists.pack(
        offsets_.cl(),
        [&](std::uint64_t count) -> const cl::Buffer& {
            reserve(records_, lists.device(), count, record.size, "copy of the lists");
            return records_.cl();
        },
        record.type() + " value", "");
}

void ContiguousLists::add_to(Arguments& arguments, const ListsCore& lists) const {
    const ListStorage& storage = lists.storage().in_use();
    if (is_copy_)
        storage.add_contiguous_to(arguments, records_, offsets_);
    else
        storage.add_to(arguments);
}

}  // namespace cellist::detail
