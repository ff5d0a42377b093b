// SPDX-License-Identifier: MIT
#pragma once

#include <initializer_list>
#include <memory>
#include <string>
#include <string_view>
#include <tuple>

#include <cellist/detail/memory.hpp>
#include <cellist/detail/record_type.hpp>
#include <cellist/kernel.hpp>

#include "device/recent.hpp"

namespace cellist::detail {

/// A source of the library: its name in the compiler's messages, and its text.
struct KernelFile {
    const char* name;
    std::string_view text;
};

/// The library's own kernels for lists of a record type. Compiles a kernel when it is first needed,
/// and keeps the last ones.
class RecordKernels {
public:
    /// The last of the definitions is the record.
    RecordKernels(MemoryOwner device, Definitions definitions);

    /// The kernel `name` of a program: the definitions, then the files. CELLIST_RECORD is the name
    /// of the record, and CELLIST_RECORD_TYPE its type. The containers among the arguments have
    /// this mode, as in view.h. `types` are those that the definitions use. The reference is valid
    /// until the next call. Throws OpenClError.
    [[nodiscard]] Kernel& get(std::initializer_list<KernelFile> files, const char* name,
                              unsigned mode, const std::string& definitions = {},
                              const Definitions& types = {});
    [[nodiscard]] const Definitions& definitions() const { return definitions_; }
    [[nodiscard]] const RecordType& record() const { return definitions_.records.back(); }
    /// Owns the memory of the container that is not of its storage.
    [[nodiscard]] const MemoryOwner& owner() const { return device_; }

private:
    /// Enough for the lists of one container, sorted by some eight keys in turn.
    static constexpr std::size_t kernels_max = 128;

    MemoryOwner device_;
    Definitions definitions_;
    /// By name, mode, and definitions with the types that they use.
    Recent<std::tuple<std::string, unsigned, std::string>, Kernel> kernels_{kernels_max};
};

}  // namespace cellist::detail
