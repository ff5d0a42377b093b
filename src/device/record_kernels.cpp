// SPDX-License-Identifier: MIT
#include "device/record_kernels.hpp"

#include <utility>

namespace cellist::detail {

RecordKernels::RecordKernels(MemoryOwner device, Definitions definitions)
    : device_(std::move(device)), definitions_(std::move(definitions)) {}

Kernel& RecordKernels::get(std::initializer_list<KernelFile> files, const char* name, unsigned mode,
                           const std::string& definitions, const Definitions& types) {
    const std::tuple id(std::string(name), mode, definitions + types.source());
    if (Kernel* known = kernels_.find(id)) return *known;
    std::string text = "#define CELLIST_RECORD " + record().name +
                       "\n#define CELLIST_RECORD_TYPE " + record().type() + "\n" + definitions;
    for (const KernelFile& file : files)
        text += std::string("#line 1 \"") + file.name + "\"\n" + std::string(file.text);
    // The record stays the last one of its own definitions.
    Definitions all = definitions_;
    all.add(types);
    all.modes = mode;
    return kernels_.add(id, Kernel(device_, Source{.text = std::move(text)}, name, all));
}

}  // namespace cellist::detail
