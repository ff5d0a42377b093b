// SPDX-License-Identifier: MIT
// Where an OpenCL call fails, whichever it is, the library throws OpenClError that names the call,
// and leaks nothing; the container keeps its lists or is empty, and then does the same work as
// ever.
#include <algorithm>
#include <iostream>
#include <optional>

#include "device/device_state.hpp"
#include "layer.hpp"
#include "scene.hpp"
#include "support/cache.hpp"
#include "support/errors.hpp"
#include "support/storages.hpp"

namespace cellist::test {
namespace {

using faults::Fault;
using faults::Plan;
using faults::References;

/// What an operation may do with failures but throw the first.
struct Leave {
    const bool& silent;  ///< throw none: known after the run
    /// Throw a later one, if all before it tell of missing memory: the library went another way
    /// each time.
    bool later;
};

/// Calls the library while calls fail by the plan. False if it makes fewer calls.
bool fails(const Plan& plan, auto&& run, const Leave& leave) {
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
    faults::disarm();
    const std::vector<Fault> faults = faults::failures();
    if (!faults.empty()) UNSCOPED_INFO(faults[0].call << ": " << error_name(faults[0].code));
    if (wrong) FAIL("not an OpenClError: " << *wrong);
    if (faults.empty()) {
        if (error) FAIL(error->what());
        return false;
    }
    if (!error && leave.silent) return true;
    REQUIRE(error.has_value());
    const auto is_thrown = [&](const Fault& fault) {
        // The C++ bindings have one name for all calls that retain objects.
        const std::string call = fault.call.starts_with("clRetain") ? "Retain Object" : fault.call;
        return error->code() == fault.code &&
               (error->call() == fault.call || error->call() == call);
    };
    auto fault = faults.begin();
    while (!is_thrown(*fault)) {
        if (!leave.later || !fault->lacks_memory() || ++fault == faults.end())
            FAIL("another error: " << error->what());
    }
    REQUIRE((error->log().empty() || error->call() == "clBuildProgram"));
    return true;
}

/// One failure in an operation, and what is left of it. False if the operation makes fewer calls.
bool fails_well(const Device& on, const Operation& operation, Storage storage, const Plan& plan) {
    Scene scene(on, storage, operation);
    const auto run = [&] {
        scene.silent = false;
        operation.run(scene);
    };
    const bool failed =
        fails(plan, run, {scene.silent, operation.kind == Kind::automatic || operation.falls_back});
    scene.require_contents();
    if (failed) {
        run();
        scene.require_contents();
    }
    return failed;
}

bool fails_well(const Device& on, const Life& life, Storage storage, const Plan& plan) {
    bool silent = false;
    const auto run = [&] {
        life.run(on, storage);
        const std::vector<Fault> faults = faults::failures();
        silent =
            life.falls_back && std::all_of(faults.begin(), faults.end(),
                                           [](const Fault& fault) { return fault.lacks_memory(); });
    };
    return fails(plan, run, {silent, life.falls_back});
}

/// Compiles what the work needs, and the checks of it.
void warm_up(const Device& on, const Operation& operation, Storage storage) {
    Scene scene(on, storage, operation);
    for (int i = 0; i < (operation.kind == Kind::automatic ? 20 : 1); ++i) operation.run(scene);
    scene.require_contents();
}
void warm_up(const Device& on, const Life& life, Storage storage) { life.run(on, storage); }

/// Makes the first call of some work fail and each `step`th after it, one in a run, on all
/// storages. Where the plan has a second failure, it moves with the first. Returns the number of
/// runs with one.
std::uint64_t inject(const Device& on, const auto& work, const Plan& plan, std::uint64_t step) {
    if (!faults::loaded()) FAIL("the environment variable OPENCL_LAYERS must name the fault layer");
    std::uint64_t injected = 0;
    for (const Storage storage : all_storages) {
        warm_up(on, work, storage);
        const References before = faults::references();
        for (Plan moved = plan;; ++injected) {
            INFO(work.name << ", " << name_of(storage) << ", call " << moved.call
                           << (moved.again != 0 ? " and " + std::to_string(moved.again) : ""));
            const bool failed = fails_well(on, work, storage, moved);
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

std::uint64_t inject_in_operations(const Device& on, const Plan& plan, std::uint64_t step) {
    std::uint64_t injected = 0;
    for (const Operation& operation : operations()) injected += inject(on, operation, plan, step);
    return injected;
}

std::uint64_t inject_in_lives(const Plan& plan, std::uint64_t step) {
    std::uint64_t injected = 0;
    for (const Life& life : lives()) injected += inject(device(), life, plan, step * life.step);
    return injected;
}

TEST_CASE("the layer sees calls and counts references") {
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
        faults::disarm();
        REQUIRE(faults::failures().size() == 1);
        REQUIRE(faults::failures()[0].call == "clFinish");
        REQUIRE(error.call() == "clFinish");
        REQUIRE(error.code() == CL_OUT_OF_RESOURCES);
    }
    REQUIRE(before == faults::references());
}

TEST_CASE("pool_bytes() is the size of every buffer that a container keeps") {
    constexpr auto source = R"(
#include <cellist/lists.clh>
kernel void insert(CELLIST_LISTS(Item, lists))
{
    const uint i = get_global_id(0);
    const Item item = {(float)(i % 1000u), i};
    cellist_insert(lists, i < 600u ? 0 : i % 9000u, item);
}
)";
    const auto use = [&](Lists<Item>& lists) {
        Kernel insert(device(), source, "insert", lists);
        for (int i = 0; i < 2; ++i) require_complete(lists.build(insert, 20'000), 20'000);
        lists.sort(&Item::key);
        lists.sort_by("record.id ^ 1u");
        lists.partial_sort(&Item::key, 2);
        lists.sort_async(&Item::id);
        (void)lists.lengths();
        (void)lists.download();
        (void)lists.pack();
        lists.append(insert, 20'000);
        REQUIRE(lists.remove_if("record.id & 1u") == 20'000);
        REQUIRE(lists.validate().ok());
    };
    CELLIST_EACH_STORAGE(storage);
    const ListsOptions options{.storage = storage};
    {
        // The device keeps programs and blocks of memory for reads.
        Lists<Item> first(device(), {9000}, options);
        use(first);
    }
    const std::uint64_t before = faults::references().buffer_bytes;
    Lists<Item> lists(device(), {9000}, options);
    // No buffer is empty for a driver: the spare heads of some storages take a byte.
    const auto difference = [&] {
        return faults::references().buffer_bytes - before - lists.pool_bytes();
    };
    REQUIRE(difference() <= 1);
    use(lists);
    REQUIRE(difference() <= 1);
}

TEST_CASE("after prepare() no program is built or loaded") {
    const auto programs = [] {
        return faults::calls_of("clBuildProgram") + faults::calls_of("clCompileProgram") +
               faults::calls_of("clLinkProgram");
    };
    CELLIST_EACH_STORAGE(storage);
    const Device on = Device::choose();
    constexpr cl_uint cells = 64;
    CELLIST_RANDOM(random, 91u);
    Inserts<Item> inserts = random_inserts(20'000, cells, random);
    Lists<Item> lists(on, {cells}, {.storage = storage});
    Inserter inserter(lists, on);
    const auto frame = [&] {
        require_complete(inserter.build(lists, inserts), inserts.size());
        lists.sort(&Item::key);
        lists.partial_sort_by("record.id ^ 1u", 4);
        (void)lists.lengths();
        (void)lists.pack(&Item::id);
        REQUIRE(lists.download().records().size() == inserts.size());
        REQUIRE(lists.validate().ok());
    };
    on.prepare(frame);
    const std::uint64_t before = programs();
    REQUIRE(before > 0);
    frame();
    for (const std::size_t size : {std::size_t{0}, std::size_t{100}, std::size_t{30'000}}) {
        inserts = random_inserts(size, cells, random);
        frame();
        std::fill(inserts.cells.begin(), inserts.cells.end(), 7u);
        frame();
    }
    REQUIRE(programs() == before);
}

TEST_CASE("a program whose file cannot be loaded is built, and a failed store stores nothing") {
    const ProgramCacheDirectory cache;
    const std::string source = "kernel void f(global uint* out, uint x) { *out = x; }";
    std::optional<Device> on;
    const auto fails_or_works = [&](const Plan& plan, const auto& run) {
        faults::arm(plan);
        std::optional<OpenClError> error;
        try {
            run();
        } catch (const OpenClError& caught) {
            error = caught;
        }
        faults::disarm();
        return !faults::failures().empty();
    };
    const auto make = [&] { Kernel(*on, source, "f"); };
    for (const Plan::Extent extent : {Plan::Extent::single, Plan::Extent::lasting}) {
        // The first device has no file to load, the second one has.
        for (std::uint64_t call = 1;; ++call) {
            std::filesystem::remove_all(cache.programs());
            on.emplace(Device::choose());
            make();
            const References before = faults::references();
            const bool failed = fails_or_works({.call = call, .extent = extent},
                                               [&] { on->state()->programs.store(); });
            INFO("store, call " << call);
            REQUIRE(before == faults::references());
            on.emplace(Device::choose());
            make();
            if (!failed) break;
        }
        REQUIRE(std::filesystem::exists(cache.programs()));
        for (std::uint64_t call = 1;; ++call) {
            on.emplace(Device::choose());
            const bool failed = fails_or_works({.call = call, .extent = extent}, make);
            INFO("load, call " << call);
            make();
            if (!failed) break;
        }
    }
}

TEST_CASE("any call fails once") {
    const std::uint64_t injected = inject_in_operations(device(), {}, 1) + inject_in_lives({}, 1);
    std::cout << "faults: " << injected << " injected, one at a time" << std::endl;
}

TEST_CASE("any call fails once for other reasons than memory") {
    const std::uint64_t injected = inject_in_operations(device(), {.code = Plan::Code::object}, 5);
    std::cout << "faults: " << injected << " injected, one at a time, that tell of invalid objects"
              << std::endl;
}

TEST_CASE("all calls fail from any one on") {
    std::uint64_t injected = 0;
    for (const Plan::Code code : {Plan::Code::resources, Plan::Code::object}) {
        const Plan plan{.extent = Plan::Extent::lasting, .code = code};
        injected += inject_in_operations(device(), plan, 9) + inject_in_lives(plan, 13);
    }
    std::cout << "faults: " << injected << " injected, with all calls after them" << std::endl;
}

TEST_CASE("a build fails and so does a call of its cleanup") {
    std::uint64_t injected = 0;
    for (const Operation& operation : operations())
        if (operation.before == Contents::empty)
            // The second failure comes so many calls after the first, wherever that is.
            for (const std::uint64_t later : {1u, 2u, 3u, 4u})
                injected += inject(device(), operation, {.call = later, .again = 2 * later}, 9);
    std::cout << "faults: " << injected << " injected, with a second one soon after" << std::endl;
}

TEST_CASE("any call fails once on an out-of-order queue") {
    std::optional<cl::CommandQueue> queue;
    try {
        queue.emplace(device().context(), cl::QueueProperties::OutOfOrder);
    } catch (const cl::Error&) {
        return;  // the device has none
    }
    const Device own(device().context(), *queue);
    const std::uint64_t injected = inject_in_operations(own, {}, 7);
    std::cout << "faults: " << injected << " injected on an out-of-order queue" << std::endl;
}

}  // namespace
}  // namespace cellist::test
