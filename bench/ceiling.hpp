#pragma once

#include <deque>

#include <cellist/cellist.hpp>

#include "support/suite.hpp"

namespace bench {

/// What the hardware allows an insert: see ceiling.cl. There are several buffers, which are used by
/// turns, as containers are. Each function returns the seconds that one run took on the device.
class Ceilings {
public:
    /// Throws std::runtime_error where the lists that exchange_and_store() makes are wrong.
    Ceilings(const Suite& suite, const Workload& workload);

    double copy();
    double store();
    double exchange();
    double exchange_and_store();
    double store_exchange_link();

private:
    struct Buffers {
        cellist::Buffer<cl_uint> heads;
        cellist::Buffer<cl_uint> nodes;
    };
    /// The buffers whose turn it is, with empty heads.
    Buffers& next();
    void check(const cellist::Device& device);

    Workload workload_;
    cellist::Source source_;
    cellist::Kernel copy_, store_, exchange_, exchange_and_store_, store_exchange_link_;
    std::deque<Buffers> buffers_;
    std::size_t turn_ = 0;
};

}  // namespace bench
