// SPDX-License-Identifier: MIT
#include "mpi/outbox.hpp"

#include <algorithm>
#include <utility>

#include <cellist/detail/build.hpp>

#include "cellist_mpi_kernels.hpp"
#include "device/device_state.hpp"
#include "device/distribution.hpp"

namespace cellist::detail {

namespace {

/// The nodes of a new outbox, which grows to the demand of a build.
constexpr std::uint64_t first_capacity = 65536;

/// Lists that drop what is too much need no look at the counters between two passes. Lists that grow
/// take one pass on processors, through partitions.
ListsOptions send_options(const DeviceInfo& device) {
    return {.storage = Storage::counted,
            .overflow = device.one_thread_per_work_group ? Overflow::grow : Overflow::drop,
            .capacity_nodes = 0};
}

/// The struct of a record and its cell, as cellist_node_T has them.
RecordType sent_type(const RecordType& record) {
    const NodeLayout layout = node_layout(record);
    const std::size_t cell =
        (record.size + sizeof(cl_uint) - 1) / sizeof(cl_uint) * sizeof(cl_uint);
    return {"cellist_sent_" + record.name,
            layout.size,
            std::max(record.alignment, sizeof(cl_uint)),
            {{"record", record.type(), {}, 0, {}, false}, {"cell", "uint", {}, cell, {}, false}},
            true};
}

}  // namespace

Definitions ExchangeKernels::sent_definitions() const {
    Definitions all = definitions_;
    all.add(sent_type(record()));
    return all;
}

Kernel& ExchangeKernels::get(const std::string& name, unsigned modes) {
    if (const auto known = kernels_.find(name); known != kernels_.end()) return known->second;
    Definitions all = sent_definitions();
    const std::string sent = all.records.back().name;
    all.modes = modes;
    const std::string text = "#define CELLIST_RECORD " + record().name +
                             "\n#define CELLIST_RECORD_TYPE " + record().type() +
                             "\n#define CELLIST_SENT " + sent + "\n#line 1 \"exchange.cl\"\n" +
                             std::string(cellist_mpi::kernels::exchange_cl);
    return kernels_.emplace(name, Kernel(device_, Source{.text = text}, name, all)).first->second;
}

Outbox::Outbox(const MemoryOwner& device, ExchangeKernels& kernels, const PartitionPlan& plan)
    : communicator_(plan.communicator()),
      kernels_(kernels),
      pool_(device, Shape{1}, ListsOptions{},
            {.node_bytes = node_layout(kernels.record()).size,
             .head_words_a_cell = 1,
             .is_linked = true}),
      distribution_(plan.distribution()),
      send_(std::make_shared<ListsCore>(device, kernels.sent_definitions(),
                                        Shape{communicator_.size()}, send_options(device->info))),
      send_offsets_(static_cast<std::size_t>(communicator_.size()) + 1, 0),
      cuts_(device, plan.cuts().size(), sizeof plan.cuts()[0], "cuts"),
      exchange_(communicator_, device) {
    pool_.allocate(communicator_.size() > 1 ? first_capacity : 0);
    cuts_.write(plan.cuts().data(), plan.cuts().size() * sizeof plan.cuts()[0]);
    clear();
}

cellist_view Outbox::view() const {
    cellist_view view{};
    view.pool_nodes = static_cast<cl_uint>(pool_.nodes_count());
    view.shard_bits = pool_.shard_bits();
    view.thread_slots = pool_.thread_slots();
    return view;
}

void Outbox::add_to(Arguments& arguments, cl_uint inserts) const {
    arguments.add_mode(CELLIST_DISTRIBUTED_MODE);
    arguments.add(pool_.nodes());
    arguments.add(pool_.counters());
    cellist_distribution now = distribution_;
    now.outbox = view();
    now.inserts = inserts;
    add_distribution(arguments, now);
}

void Outbox::fill(const std::function<void(cl_uint)>& run, cl_uint inserts) {
    pool_.start_build();
    Counters::Sum sum;
    for (;;) {
        clear();
        run(inserts);
        Counters counters;
        ReadbackFence fence;
        fence.add(pool_.read(counters));
        fence.wait();
        sum = counters.sum();
        if (sum.dropped == 0) break;
        const BuildReport report{.attempted = sum.allocated + sum.dropped};
        pool_.require(report.attempted, report);
        pool_.grow(report.attempted, report);
        // The rank's own records are already in its lists.
        inserts = CELLIST_INSERT_FOREIGN;
    }
    if (sum.allocated == 0) return clear_send_lists();
    reserve_send_lists(sum.allocated);
    fill_send_lists([&](ListsCore& send) {
        const cellist_view outbox = view();
        Arguments arguments;
        send.add_to(arguments);
        arguments.add(pool_.nodes());
        arguments.add(pool_.counters());
        arguments.append(Arguments::Kind::value, &outbox, sizeof outbox);
        arguments.append(Arguments::Kind::value, &distribution_.domain,
                         sizeof distribution_.domain);
        arguments.add(cuts_);
        kernels_.get("cellist_route", arguments.modes())
            .enqueue(Range::padded(std::min<std::uint64_t>(sum.end, outbox.pool_nodes)), arguments);
    });
}

/// With room for a part more: the number of records changes from step to step.
void Outbox::reserve_send_lists(std::uint64_t records) {
    NodePool& pool = send_pool();
    if (records <= pool.capacity_nodes()) return;
    pool.require(records, {.attempted = records});
    const std::uint64_t roomy = records + records / 8;
    pool.allocate(pool.refusal(roomy) ? records : roomy);
}

void Outbox::fill_send_lists(const std::function<void(ListsCore&)>& insert) {
    for (;;) {
        const auto build = Build::start({send_.get()}, [&] { insert(*send_); });
        send_->make_ready_for_commands();
        send_pool().heads().read(send_offsets_.data(), send_offsets_.size() * sizeof(cl_uint));
        const BuildReport report = build->finish().front();
        if (report.dropped == 0) return;
        reserve_send_lists(report.attempted);
    }
}

void Outbox::clear_send_lists() { std::fill(send_offsets_.begin(), send_offsets_.end(), 0); }

void Outbox::send() {
    received_ = exchange_.run(send_pool().nodes(), send_offsets_, send_pool().node_bytes());
}

void Outbox::insert_received(Arguments arguments) {
    if (received_ == 0) return;
    arguments.add(exchange_.received());
    arguments.add(static_cast<cl_uint>(received_));
    kernels_.get("cellist_receive", arguments.modes()).enqueue(Range::padded(received_), arguments);
}

}  // namespace cellist::detail
