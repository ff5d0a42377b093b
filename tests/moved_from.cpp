// SPDX-License-Identifier: MIT
// What was moved from throws an error that says so, whatever is asked of it.
#include <functional>

#include "support/errors.hpp"
#include "support/inserts.hpp"

namespace cellist::test {
namespace {

void require_refused(const char* what, const std::vector<std::function<void()>>& uses) {
    for (std::size_t i = 0; i < uses.size(); ++i) {
        INFO(what << ", use " << i);
        const Error error = error_of(uses[i]);
        INFO(error.what());
        REQUIRE(contains(error.what(), what));
        REQUIRE(contains(error.what(), "moved from"));
    }
}

TEST_CASE("whatever was moved from is refused, and the other end works") {
    Device first = Device::choose();
    const Device now = std::move(first);
    Lists<Item> lists(now, {5});
    Lists<Item> kept = std::move(lists);
    Buffer<cl_uint> buffer(now, std::vector<cl_uint>{1, 2, 3});
    const Buffer<cl_uint> held = std::move(buffer);
    const std::string source = insert_source("Item") + "kernel void nothing(global uint* x) {}";
    Kernel kernel(now, source, "insert_all", kept);
    Kernel insert = std::move(kernel);
    Kernel nothing(now, source, "nothing", kept);

    require_refused("Device", {
                                  [&] { (void)first.info(); },
                                  [&] { (void)first.context(); },
                                  [&] { (void)first.queue(); },
                                  [&] { first.finish(); },
                                  [&] { first.enqueue_wait({cl::Event()}); },
                                  [&] { (void)first.enqueue_marker(); },
                                  [&] { first.prepare([] {}); },
                                  [&] { Lists<Item>(first, {5}); },
                                  [&] { Buffer<cl_uint>(first, 5); },
                                  [&] { Kernel(first, source, "nothing", type<Item>); },
                              });
    require_refused("Lists", {
                                 [&] { lists.build([] {}); },
                                 [&] { lists.build(insert, 1); },
                                 [&] { (void)lists.build_async([] {}); },
                                 [&] { (void)lists.build_async(insert, 1); },
                                 [&] { cellist::build([] {}, kept, lists); },
                                 [&] { lists.build_slices([] {}, [](const Slice&) {}); },
                                 [&] { lists.clear(); },
                                 [&] { lists.sort(&Item::key); },
                                 [&] { lists.sort_by("record.key"); },
                                 [&] { lists.partial_sort(&Item::key, 1); },
                                 [&] { lists.sort_async(&Item::key); },
                                 [&] { (void)lists.lengths(); },
                                 [&] { (void)lists.download(); },
                                 [&] { (void)lists.download_async(); },
                                 [&] { (void)lists.pack(); },
                                 [&] { (void)lists.pack(&Item::id); },
                                 [&] { (void)lists.validate(); },
                                 [&] { (void)lists.validate_async(); },
                                 [&] { (void)lists.shape(); },
                                 [&] { (void)lists.capacity_nodes(); },
                                 [&] { (void)lists.pool_bytes(); },
                                 [&] { (void)lists.storage(); },
                                 [&] { (void)lists.storage_reason(); },
                                 [&] { insert.run(1, lists, held, held, cl_uint{1}); },
                                 [&] { Kernel(now, source, "nothing", lists); },
                             });
    require_refused("Buffer", {
                                  [&] { (void)buffer.size(); },
                                  [&] { (void)buffer.cl(); },
                                  [&] { (void)buffer.download(); },
                                  [&] { (void)buffer.download_async(); },
                                  [&] { (void)buffer.download(0, 0); },
                                  [&] { buffer.upload({}); },
                                  [&] { buffer.upload_async(std::vector<cl_uint>{1}); },
                                  [&] { buffer.upload_async({}); },
                                  [&] { buffer.fill(1); },
                                  [&] { nothing.run(1, buffer); },
                              });
    require_refused("Kernel", {
                                  [&] { kernel.run(1, kept, held, held, cl_uint{1}); },
                                  [&] { (void)kernel.name(); },
                                  [&] { (void)kernel.cl(); },
                                  [&] { (void)kernel.log(); },
                                  [&] { kept.build(kernel, 1); },
                              });

    REQUIRE(held.download() == std::vector<cl_uint>{1, 2, 3});
    Inserts<Item> inserts;
    inserts.add(3, {1.0f, 1});
    require_complete(Inserter(kept, now).build(kept, inserts), 1);
    // What was moved from takes a new value.
    lists = Lists<Item>(now, {5});
    require_complete(Inserter(lists, now).build(lists, inserts), 1);
}

}  // namespace
}  // namespace cellist::test
