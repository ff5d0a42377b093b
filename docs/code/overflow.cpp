// SPDX-License-Identifier: MIT
#include <cellist/cellist.hpp>

#include "check.hpp"

struct Sample {
    cl_uint value;
};
CELLIST_STRUCT(Sample, value);

constexpr auto source = R"(
#include <cellist/lists.clh>

kernel void sample(CELLIST_LISTS(Sample, samples), uint cells)
{
    Sample s = { get_global_id(0) };
    cellist_insert(samples, s.value % cells, s);
}
)";

void grow(const cellist::Device& device) {
    cellist::Lists<Sample> samples(device, {100}, {.capacity_nodes = 1000});
    cellist::Kernel sample(device, source, "sample", samples);

    cellist::BuildReport report = samples.build(sample, 50'000, cl_uint{100});
    std::cout << report.stored << " stored in " << report.passes << " passes, capacity now "
              << report.capacity_nodes << '\n';
    check(report.passes == 2 && report.capacity_nodes == 50'000, "grow");

    report = samples.build(sample, 50'000, cl_uint{100});  // the pool is large enough now
    check(report.passes == 1, "one pass");
}

void grow_within_a_budget(const cellist::Device& device) {
    cellist::Lists<Sample> samples(device, {100}, {.budget_bytes = 1 << 20});
    cellist::Kernel sample(device, source, "sample", samples);
    try {
        samples.build(sample, 1'000'000, cl_uint{100});
        check(false, "a build over the budget throws");
    } catch (const cellist::OverflowError& error) {
        std::cout << error.what() << '\n';
        std::cout << "needed: " << error.report().stored + error.report().dropped << " nodes\n";
    }
    check(samples.lengths().total == 0, "nothing half-built is left");
}

void stop(const cellist::Device& device) {
    cellist::Lists<Sample> samples(device, {100},
                                   {.overflow = cellist::Overflow::stop, .capacity_nodes = 1000});
    cellist::Kernel sample(device, source, "sample", samples);
    try {
        samples.build(sample, 1001, cl_uint{100});
        check(false, "a build over the capacity throws");
    } catch (const cellist::OverflowError& error) {
        std::cout << error.what() << '\n';
    }
    check(samples.build(sample, 1000, cl_uint{100}).stored == 1000, "usable after the error");
}

void drop(const cellist::Device& device) {
    cellist::Lists<Sample> samples(device, {100},
                                   {.overflow = cellist::Overflow::drop, .capacity_nodes = 1000});
    cellist::Kernel sample(device, source, "sample", samples);

    cellist::BuildReport report = samples.build(sample, 50'000, cl_uint{120});
    std::cout << report.attempted << " = " << report.stored << " stored + " << report.dropped
              << " dropped + " << report.rejected << " rejected\n";
    check(report.stored == 1000, "the pool is full");
    check(report.attempted == report.stored + report.dropped + report.rejected, "the sum");
    check(samples.validate().ok(), "every list is valid");
}

void keep_nearest(const cellist::Device& device) {
    cellist::Lists<Sample> nearest(device, {100}, {.storage = cellist::nearest(&Sample::value, 4)});
    cellist::Kernel sample(device, source, "sample", nearest);
    cellist::BuildReport report = nearest.build(sample, 50'000, cl_uint{100});
    check(report.stored == 400 && report.dropped == 49'600, "four of each cell");
    for (const Sample& kept : nearest.download().records())
        check(kept.value < 400, "the least values are kept");
}

int main() {
    cellist::Device device = cellist::Device::choose();
    grow(device);
    grow_within_a_budget(device);
    stop(device);
    drop(device);
    keep_nearest(device);
}
