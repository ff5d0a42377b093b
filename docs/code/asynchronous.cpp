// SPDX-License-Identifier: MIT
#include <cellist/cellist.hpp>

#include "check.hpp"

struct Sample {
    cl_float key;
    cl_uint id;
};
CELLIST_STRUCT(Sample, key, id);

constexpr auto source = R"(
#include <cellist/lists.clh>

kernel void sample(CELLIST_LISTS(Sample, samples), global const float* keys)
{
    uint i = get_global_id(0);
    Sample s = { keys[i], i };
    cellist_insert(samples, i % 100, s);
}
)";

int main() {
    cellist::Device device = cellist::Device::choose();
    const std::vector<cl_float> host(50'000, 1.0f);
    cellist::Buffer<cl_float> keys(device, host.size());

    cellist::Lists<Sample> samples(device, {100},
                                   {.overflow = cellist::Overflow::drop, .capacity_nodes = 40'000});
    cellist::Kernel sample(device, source, "sample", samples);

    keys.upload_async(host);  // keep host unchanged until the upload completes
    cellist::Pending<cellist::BuildReport> built = samples.build_async(sample, 50'000, keys);
    samples.sort_async(&Sample::key);
    cellist::Pending<cellist::Lengths> lengths = samples.lengths_async();
    // ... the host does other work ...
    std::cout << built.get().dropped << " dropped, longest list " << lengths.get().longest << '\n';

    // Your own queue in the same context, next to the library's queue.
    const auto cl_device = device.queue().getInfo<CL_QUEUE_DEVICE>();
    const cl::CommandQueue own_queue(device.context(), cl_device);
    cl::Event copied;
    own_queue.enqueueWriteBuffer(keys.cl(), CL_FALSE, 0, host.size() * sizeof(cl_float),
                                 host.data(), nullptr, &copied);
    own_queue.flush();

    device.enqueue_wait({copied});  // the library's next commands start after this event
    samples.build(sample, 50'000, keys);
    cl::Event done = device.enqueue_marker();  // completes after all enqueued work
    done.wait();
    check(samples.lengths().total == 40'000, "the pool is full");
    std::cout << "asynchronous: ok\n";
}
