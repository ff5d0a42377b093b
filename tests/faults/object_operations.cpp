// SPDX-License-Identifier: MIT
// Operations on objects other than lists, and on empty lists.
#include <span>

#include "checks.hpp"
#include "operations.hpp"

namespace cellist::test {
namespace {

void make_a_container(Scene& scene) {
    const Lists<Item> lists(scene.device, {cell_count}, scene.options);
    require(Contents::empty, lists, scene.oracle);
}

void make_a_kernel(Scene& scene) { Kernel(scene.device, scene_source(), "insert", scene.lists); }

void use_buffers(Scene& scene) {
    Buffer<Item> buffer(scene.device, scene.inserts.records);
    std::vector<Item> found = buffer.download();
    REQUIRE(found == scene.inserts.records);
    buffer.fill({2.0f, 5});
    found = buffer.download_async().get();
    REQUIRE(found == std::vector<Item>(insert_count, {2.0f, 5}));
    buffer.upload(std::span(scene.inserts.records).first(1), 2);
    found = buffer.download(2, 1);
    REQUIRE(found[0] == scene.inserts.records[0]);
    buffer.upload_async(scene.inserts.records);
    scene.device.finish();
    found = buffer.download();
    REQUIRE(found == scene.inserts.records);
    struct Three {
        cl_uchar bytes[3];
    };
    Buffer<Three> odd(scene.device, 7);
    odd.fill({{1, 2, 3}});
    const std::vector<Three> last = odd.download();
    REQUIRE(last[6].bytes[2] == 3);
}

void wait_for_events(Scene& scene) {
    std::vector<cl::Event> events;
    events.push_back(scene.device.enqueue_marker());
    scene.device.enqueue_wait(events);
    scene.device.finish();
}

void clear(Scene& scene) {
    scene.lists_hold = Contents::empty;
    scene.lists.clear();
}

}  // namespace

std::span<const Operation> object_operations() {
    using enum Contents;
    static constexpr Operation table[] = {
        {"make a container", empty, make_a_container},
        {"make a kernel", empty, make_a_kernel},
        {"use buffers", empty, use_buffers},
        {"wait for events", empty, wait_for_events},
        {"clear", full, clear},
    };
    return table;
}

}  // namespace cellist::test
