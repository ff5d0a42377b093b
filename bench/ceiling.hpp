// SPDX-License-Identifier: MIT
#pragma once

#include <deque>

#include <cellist/cellist.hpp>

#include "support/suite.hpp"

namespace bench {

/// The hardware's limits for an insert; see ceiling.cl. Several buffers are used in turn, as
/// containers are. Each function returns the device seconds of one run.
class Ceilings {
public:
    /// Throws std::runtime_error if the lists of exchange_and_store() are wrong.
    Ceilings(const Suite& suite, const Workload& workload);

    double copy();
    double store();
    double exchange();
    double exchange_and_store();
    double allocate_exchange_and_store();

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
    cellist::Kernel copy_, store_, exchange_, exchange_and_store_, allocate_exchange_and_store_;
    cellist::Buffer<cl_uint> counters_;  ///< of allocate_exchange_and_store_
    std::deque<Buffers> buffers_;
    std::size_t turn_ = 0;
};

}  // namespace bench
