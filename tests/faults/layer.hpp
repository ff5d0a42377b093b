// SPDX-License-Identifier: MIT
#pragma once
// The fault layer: an OpenCL layer that the loader puts between a program and the drivers where the
// environment variable OPENCL_LAYERS names it. It makes chosen calls fail, and counts the
// references that the program holds. The program links it, too, and controls it through these
// functions.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace cellist::faults {

/// What fails, counted from arm() on. Releases never fail and do not count: they have no error that
/// a program could act on.
struct Plan {
    std::uint64_t call = 1;   ///< this call fails: 1 is the next one
    std::uint64_t again = 0;  ///< and that one: 0 is none
    /// All calls after `call` fail as well: the device is lost.
    enum class Extent { single, lasting } extent = Extent::single;
    /// What the codes tell: memory or other resources are short, or the first object that the call
    /// takes is not valid.
    enum class Code { resources, object } code = Code::resources;
};

/// A call that failed.
struct Fault {
    std::string call;  ///< e.g. "clCreateBuffer"
    int code = 0;      ///< e.g. CL_MEM_OBJECT_ALLOCATION_FAILURE

    /// Whether the code tells that memory is missing.
    [[nodiscard]] bool lacks_memory() const;
};

/// Makes calls fail until disarm().
void arm(const Plan& plan);
/// Lets all calls through again.
void disarm();
/// The calls that have failed since arm().
std::vector<Fault> failures();

/// How often the program has called an entry point that can fail, e.g. "clBuildProgram".
std::uint64_t calls_of(const std::string& call);

/// Lets calls of its scope through and does not count them: those of the test, not of the library.
class Pause {
public:
    Pause();
    ~Pause();
    Pause(const Pause&) = delete;
    Pause& operator=(const Pause&) = delete;
};

/// References that the program holds, by kind of object. An object is alive while there is one.
struct References {
    enum Kind { context, queue, program, kernel, buffer, image, sampler, event, kinds };
    std::array<std::uint64_t, kinds> held{};
    std::uint64_t buffer_bytes = 0;  ///< of the buffers that are alive
    /// Releases of objects that the program had no reference to; the drivers never saw them.
    std::uint64_t too_many_releases = 0;

    friend bool operator==(const References&, const References&) = default;
    /// "1 context, 2 buffer"
    [[nodiscard]] std::string to_string() const;
};
References references();

/// Whether the loader has loaded the layer. It does on the first OpenCL call.
bool loaded();

}  // namespace cellist::faults
