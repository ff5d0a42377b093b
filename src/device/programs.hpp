// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <mutex>
#include <optional>
#include <string>

#include <cellist/device.hpp>

#include "device/program_files.hpp"
#include "device/recent.hpp"

namespace cellist::detail {

/// A program that is ready for use.
struct Program {
    cl::Program program = {};
    std::optional<std::string> stored_log = {};  ///< of a program from a file
    bool has_file = false;                       ///< or does not need one

    /// The compiler's log. Throws OpenClError.
    [[nodiscard]] std::string log(const cl::Device& device) const;
};

/// The programs of a device: the last ones in memory, and more in files.
class Programs {
public:
    /// All of these must live as long as the object.
    Programs(const cl::Context& context, const cl::Device& device, const DeviceInfo& info);

    /// The program with this source and these options. Builds it unless it is among the last ones
    /// or in a file. Always builds it if the source or the options include other files, which may
    /// have changed. Throws OpenClError with the compiler's log. Any thread may call it.
    [[nodiscard]] Program get(const std::string& source, const std::string& options);

    /// Stores the programs of this process that are not in files yet. Any thread may call it.
    void store();

    /// Programs that are kept. One takes about 1 MB of the host under PoCL.
    static constexpr std::size_t programs_max = 128;
    /// How many are kept now. Any thread may call it.
    [[nodiscard]] std::size_t size() {
        const std::lock_guard lock(mutex_);
        return programs_.size();
    }

private:
    [[nodiscard]] Program build(const std::string& source, const std::string& options) const;
    [[nodiscard]] std::optional<Program> load(const std::string& key,
                                              const std::string& options) const;
    void store(const std::string& key, Program& program) const;

    const cl::Context& context_;
    const cl::Device& device_;
    /// The driver gives the binary of a program without compiling it for that. PoCL compiles all
    /// kernels again; its own cache keeps programs as well.
    bool stores_at_once_;
    ProgramFiles files_;
    std::mutex mutex_;
    Recent<std::string, Program> programs_{programs_max};  ///< by options and source
};

}  // namespace cellist::detail
