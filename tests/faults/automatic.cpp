// Where an OpenCL call fails while Storage::automatic tries the storages, the build fails with it or
// takes another storage; nothing leaks, and the builds that follow are whole.
#include <iostream>

#include "layer.hpp"
#include "support/inserts.hpp"
#include "support/storages.hpp"

namespace cellist::test {
namespace {

using faults::Plan;
using faults::References;

class Trial {
public:
    explicit Trial(Overflow overflow, Storage storage = Storage::automatic)
        : lists_(device(), {17},
                 {.storage = storage, .overflow = overflow, .capacity_nodes = 200, .slots = 10}),
          inserts_(items()),
          cells_(device(), inserts_.cells),
          records_(device(), inserts_.records),
          insert_(device(), insert_source("Item"), "insert_all", lists_) {}

    BuildReport build() {
        return lists_.build(insert_, Range::padded(inserts_.size(), 32), cells_, records_,
                            static_cast<cl_uint>(inserts_.size()));
    }
    /// A build of each storage, and some more.
    void build_all() {
        for (int i = 0; i < 14; ++i) build();
    }
    void require_sound_and_full() {
        require_complete(build(), inserts_.size());
        require_sound(lists_, inserts_.size());
        require_same(lists_.download(), oracle_of(inserts_, 17));
    }
    void require_empty_or_full() {
        const HostLists<Item> found = lists_.download();
        require_sound(lists_, found.records().size());
        if (found.records().size() > 0) require_same(found, oracle_of(inserts_, 17));
    }

private:
    static Inserts<Item> items() {
        std::mt19937 random(303);
        return random_inserts(93, 17, random);
    }

    Lists<Item> lists_;
    Inserts<Item> inserts_;
    Buffer<cl_uint> cells_;
    Buffer<Item> records_;
    Kernel insert_;
};

/// Compiles what a trial needs, and the checks of it, in each storage: programs stay.
void warm_up() {
    for (const Storage storage : all_storages) {
        Trial trial(Overflow::grow, storage);
        trial.require_sound_and_full();
        trial.require_empty_or_full();
    }
    Trial(Overflow::grow).build_all();
}

/// Makes one call in each `step` fail. Returns the number of runs with a failure.
std::uint64_t inject(Overflow overflow, Plan plan, std::uint64_t step) {
    const References before = faults::references();
    // How many calls there are depends on what is measured.
    for (std::uint64_t injected = 0;; plan.call += step, ++injected) {
        INFO("call " << plan.call);
        faults::Fault fault;
        {
            Trial trial(overflow);
            bool thrown = false;
            faults::arm(plan);
            try {
                trial.build_all();
            } catch (const OpenClError&) {
                thrown = true;
            }
            fault = faults::disarm();
            // A single failure may end in another storage.
            if (plan.extent == Plan::Extent::lasting) REQUIRE(thrown == !fault.call.empty());
            if (fault.call.empty()) REQUIRE_FALSE(thrown);
            trial.require_empty_or_full();
            trial.require_sound_and_full();
        }
        const References after = faults::references();
        INFO("before: " << before.to_string() << "; after: " << after.to_string());
        REQUIRE(before == after);
        if (fault.call.empty()) return injected;
    }
}

TEST_CASE("any call fails while storages are tried") {
    warm_up();
    std::uint64_t injected = inject(Overflow::grow, {}, 3);
    injected += inject(Overflow::stop, {.code = Plan::Code::object}, 7);
    injected += inject(Overflow::stop, {.extent = Plan::Extent::lasting}, 7);
    std::cout << "faults: " << injected << " injected in trials of Storage::automatic" << std::endl;
}

}  // namespace
}  // namespace cellist::test
