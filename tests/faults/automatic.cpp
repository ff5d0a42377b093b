// Where an OpenCL call fails while Storage::automatic tries the storages, the build fails with it or
// takes another storage; nothing leaks, and the builds that follow are whole.
#include <iostream>

#include "layer.hpp"
#include "support/inserts.hpp"

namespace cellist::test {
namespace {

using faults::Plan;
using faults::References;

class Trial {
public:
    explicit Trial(Overflow overflow)
        : lists_(device(), {17},
                 {.storage = Storage::automatic,
                  .overflow = overflow,
                  .capacity_nodes = 200,
                  .slots = 10}),
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

TEST_CASE("any call fails once while storages are tried") {
    std::uint64_t injected = 0;
    for (const Overflow overflow : {Overflow::grow, Overflow::stop})
        for (const auto code : {Plan::Code::resources, Plan::Code::object})
            for (const auto extent : {Plan::Extent::single, Plan::Extent::lasting}) {
                Trial(overflow).build_all();
                const References before = faults::references();
                // How many calls there are depends on what is measured.
                for (std::uint64_t call = 1;; call += 13, ++injected) {
                    INFO("call " << call << ", code " << static_cast<int>(code) << ", extent "
                                 << static_cast<int>(extent));
                    bool failed = false;
                    {
                        Trial trial(overflow);
                        faults::arm({.call = call, .extent = extent, .code = code});
                        try {
                            trial.build_all();
                        } catch (const OpenClError&) {
                            failed = true;
                        }
                        const faults::Fault fault = faults::disarm();
                        if (extent == Plan::Extent::lasting) REQUIRE(failed == !fault.call.empty());
                        failed = !fault.call.empty();
                        trial.require_empty_or_full();
                        for (int i = 0; i < 3; ++i) trial.require_sound_and_full();
                    }
                    REQUIRE(before == faults::references());
                    if (!failed) break;
                }
            }
    std::cout << "faults: " << injected << " injected in trials of Storage::automatic" << std::endl;
}

}  // namespace
}  // namespace cellist::test
