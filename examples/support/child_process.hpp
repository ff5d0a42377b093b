// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace support {

struct ChildLimits {
    unsigned processor_s;  ///< time on the processor; a process that waits has four times this
    std::uint64_t memory_bytes;  ///< that the child may allocate
    std::uint64_t result_bytes;  ///< that it may return
};

/// Runs code that may crash, hang or take all memory in a child process, and returns its result.
/// The child is a fork: it has no other threads, writes nothing to the terminal, and runs no exit
/// handlers. Blocks until the child ends. Throws InputError with the message of an InputError in
/// the child, or with a message that says how the child ended.
[[nodiscard]] std::string run_in_child(const std::function<std::string()>& work,
                                       const ChildLimits& limits);

}  // namespace support
