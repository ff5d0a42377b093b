// Where an OpenCL call fails, whichever it is, the library throws OpenClError that names the call, and
// leaks nothing; the container keeps its lists or is empty, and then does the same work as ever.
#include <iostream>
#include <optional>

#include "layer.hpp"
#include "operations.hpp"
#include "support/errors.hpp"
#include "support/storages.hpp"

namespace cellist::test {
namespace {

using faults::Fault;
using faults::Plan;
using faults::References;

/// Calls the library while calls fail by the plan. The first that failed, if it makes so many.
/// `overflowed` tells whether an overflow was reported in place of the failure.
std::optional<Fault> failure_of(const Plan& plan, auto&& run, const bool& overflowed) {
    std::optional<OpenClError> error;
    std::optional<std::string> wrong;
    faults::arm(plan);
    try {
        run();
    } catch (const OpenClError& caught) {
        error = caught;
    } catch (const std::exception& caught) {
        wrong = caught.what();
    } catch (...) {
        faults::disarm();
        throw;
    }
    const Fault fault = faults::disarm();
    INFO(fault.call << " failed with " << error_name(fault.code));
    if (wrong) FAIL("not an OpenClError: " << *wrong);
    if (fault.call.empty()) {
        if (error) FAIL(error->what());
        return {};
    }
    if (!error && overflowed) return fault;
    REQUIRE(error.has_value());
    INFO(error->what());
    REQUIRE(error->code() == fault.code);
    // The C++ bindings have no name for the calls that retain objects.
    REQUIRE(error->call() == (fault.call.starts_with("clRetain") ? "Retain Object" : fault.call));
    REQUIRE((error->log().empty() || fault.call == "clBuildProgram"));
    return fault;
}

/// One failure in an operation, and what is left of it. False if the operation makes fewer calls.
bool fails_well(const Operation& operation, Storage storage, const Plan& plan) {
    Scene scene(storage, operation);
    const auto run = [&] { operation.run(scene); };
    const bool failed = failure_of(plan, run, scene.overflowed).has_value();
    scene.require_contents();
    if (failed) {
        run();
        scene.require_contents();
    }
    return failed;
}

bool fails_well(const Life& life, Storage storage, const Plan& plan) {
    return failure_of(
               plan, [&] { life.run(storage); }, false)
        .has_value();
}

/// Compiles what the work needs, and the checks of it.
void warm_up(const Operation& operation, Storage storage) {
    Scene scene(storage, operation);
    operation.run(scene);
    scene.require_contents();
}
void warm_up(const Life& life, Storage storage) { life.run(storage); }

/// Makes the first call of some work fail and each `step`th after it, one in a run, on all storages.
/// Where the plan has a second failure, it moves with the first. Returns the number of runs with one.
std::uint64_t inject(const auto& work, const Plan& plan, std::uint64_t step) {
    std::uint64_t injected = 0;
    for (const Storage storage : all_storages) {
        warm_up(work, storage);
        const References before = faults::references();
        for (Plan moved = plan;; ++injected) {
            INFO(work.name << ", " << name_of(storage) << ", call " << moved.call
                           << (moved.again != 0 ? " and " + std::to_string(moved.again) : ""));
            const bool failed = fails_well(work, storage, moved);
            const References after = faults::references();
            INFO("before: " << before.to_string() << "; after: " << after.to_string());
            REQUIRE(before == after);
            if (!failed) break;
            moved.call += step;
            if (moved.again != 0) moved.again += step;
        }
    }
    return injected;
}

std::uint64_t inject_everywhere(const Plan& plan, std::uint64_t step) {
    std::uint64_t injected = 0;
    for (const Operation& operation : operations()) injected += inject(operation, plan, step);
    for (const Life& life : lives()) injected += inject(life, plan, step * life.step);
    return injected;
}

TEST_CASE("the layer sees the calls, and counts the references") {
    const Buffer<cl_uint> warm(device(), 1);
    REQUIRE(faults::loaded());
    const References before = faults::references();
    {
        const Buffer<cl_uint> buffer(device(), 1);
        const cl::Buffer copy = buffer.cl();
        const References held = faults::references();
        REQUIRE(held.held[References::buffer] == before.held[References::buffer] + 2);
        faults::arm({.call = 2});
        device().finish();
        const auto error = error_of<OpenClError>([] { device().finish(); });
        device().finish();
        REQUIRE(faults::disarm().call == "clFinish");
        REQUIRE(error.call() == "clFinish");
        REQUIRE(error.code() == CL_OUT_OF_RESOURCES);
    }
    REQUIRE(before == faults::references());
}

TEST_CASE("any call fails once") {
    std::cout << "faults: " << inject_everywhere({}, 1) << " injected, one at a time" << std::endl;
}

TEST_CASE("any call fails once, not for want of memory") {
    std::cout << "faults: " << inject_everywhere({.code = Plan::Code::object}, 5)
              << " injected, one at a time, that tell of invalid objects" << std::endl;
}

TEST_CASE("all calls fail from any one on") {
    const Plan plan{.extent = Plan::Extent::lasting, .code = Plan::Code::object};
    std::cout << "faults: " << inject_everywhere(plan, 3) << " injected, with all calls after them"
              << std::endl;
}

TEST_CASE("a build fails, and so does a call of its cleanup") {
    std::uint64_t injected = 0;
    for (const Operation& operation : operations())
        if (operation.before == Contents::empty)
            for (const std::uint64_t later : {1u, 2u, 3u, 4u})
                injected += inject(operation, {.call = 1, .again = 1 + later}, 3);
    std::cout << "faults: " << injected << " injected, with a second one soon after" << std::endl;
}

}  // namespace
}  // namespace cellist::test
